#include "master/http/live/session.h"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/redirect_error.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <utility>

#include "master/http/api_error.h"
#include "master/http/live/json.h"

namespace rayfarm {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Clock = std::chrono::steady_clock;

constexpr auto look_interval = std::chrono::milliseconds(100);
constexpr std::size_t longest_text = 4096;  // bytes, from a viewer

websocket::stream_base::timeout timeouts(std::chrono::milliseconds patience) {
  return {.handshake_timeout = std::chrono::seconds(10), .idle_timeout = patience, .keep_alive_pings = true};
}

}  // namespace

struct LiveSessions::Session {
  Session(HttpStream stream, std::function<bool()> may_stay, std::set<Session*>& all)
      : socket(std::move(stream)),
        may_stay(std::move(may_stay)),
        news(socket.get_executor(), Clock::time_point::max()),
        all(all) {
    all.insert(this);
  }
  ~Session() { all.erase(this); }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  void end() {
    has_ended = true;
    news.cancel();
    beast::get_lowest_layer(socket).close();
  }

  websocket::stream<HttpStream> socket;
  const std::function<bool()> may_stay;
  Viewer viewer;
  asio::steady_timer news;  // never expires: cancelled when there may be something to send
  std::optional<Clock::time_point> writing_since;
  bool has_ended = false;
  std::set<Session*>& all;
};

LiveSessions::LiveSessions(asio::io_context& io, asio::thread_pool& threads, const Doors& doors,
                           std::chrono::milliseconds patience)
    : io_(io), threads_(threads), patience_(patience), reporter_(doors) {}

asio::awaitable<void> LiveSessions::serve(HttpStream stream,
                                          beast::http::request<beast::http::string_body> request,
                                          std::function<bool()> may_stay) {
  stream.next_layer().expires_never();  // the WebSocket has deadlines of its own
  const auto session = std::make_shared<Session>(std::move(stream), std::move(may_stay), sessions_);
  session->socket.set_option(timeouts(patience_));
  session->socket.read_message_max(longest_text);
  session->socket.auto_fragment(false);
  try {
    co_await session->socket.async_accept(request, asio::use_awaitable);
    if (!std::exchange(is_reporting_, true)) asio::co_spawn(io_, report(), asio::detached);
    asio::co_spawn(io_, write_all(session), asio::detached);
    co_await read_all(*session);
  } catch (const std::exception&) {  // it has gone, or was left
  }
  session->end();
}

/// Ends when the viewer does, or says what it may not.
asio::awaitable<void> LiveSessions::read_all(Session& session) {
  std::string objection;
  while (objection.empty()) {
    beast::flat_buffer buffer;
    co_await session.socket.async_read(buffer, asio::use_awaitable);
    try {
      if (!session.socket.got_text()) throw ApiError(400, "a viewer speaks text");
      watch(session, beast::buffers_to_string(buffer.data()));
    } catch (const ApiError& error) {
      objection = error.what();
    }
  }
  co_await say_why(session, objection);
}

asio::awaitable<void> LiveSessions::say_why(Session& session, std::string reason) {
  constexpr std::size_t longest_reason = 120;  // bytes; the protocol's limit is 123
  reason.resize(std::min(reason.size(), longest_reason));
  const websocket::close_reason why(websocket::close_code::policy_error, reason);
  co_await session.socket.async_close(why, asio::use_awaitable);
}

void LiveSessions::watch(Session& session, const std::string& text) {
  std::vector<std::shared_ptr<const LayerFeed>> feeds;
  for (const LayerName& name : layers_to_watch(text)) feeds.push_back(hub_.feed(name));
  session.viewer.watch(std::move(feeds));
  session.news.cancel();
}

asio::awaitable<void> LiveSessions::write_all(std::shared_ptr<Session> session) {
  boost::system::error_code woken, failed;
  while (!session->has_ended && !failed) {
    const std::optional<LiveMessage> message = session->viewer.next(hub_.board());
    if (!message) {
      co_await session->news.async_wait(asio::redirect_error(asio::use_awaitable, woken));
      continue;
    }
    session->writing_since = Clock::now();
    session->socket.text(message->is_text);
    const asio::const_buffer bytes(message->bytes->data(), message->bytes->size());
    co_await session->socket.async_write(bytes, asio::redirect_error(asio::use_awaitable, failed));
    session->writing_since.reset();
  }
  session->end();
}

/// While anybody looks.
asio::awaitable<void> LiveSessions::report() {
  asio::steady_timer pause(io_);
  while (!sessions_.empty()) {
    pause.expires_after(look_interval);
    asio::awaitable<LiveNews> looking = look_up(hub_.wish());
    LiveNews news = co_await asio::co_spawn(threads_, std::move(looking), asio::use_awaitable);
    hub_.take(std::move(news));
    leave_some();
    for (Session* session : sessions_) session->news.cancel();
    co_await pause.async_wait(asio::use_awaitable);
  }
  hub_.clear();
  is_reporting_ = false;
}

asio::awaitable<LiveNews> LiveSessions::look_up(LiveWish wish) { co_return reporter_.look_up(wish); }

/// Those who take nothing, and those who are nobody any more.
void LiveSessions::leave_some() {
  const Clock::time_point now = Clock::now();
  for (Session* session : sessions_)
    if (!session->may_stay() || (session->writing_since && now - *session->writing_since > patience_))
      session->end();
}

}  // namespace rayfarm
