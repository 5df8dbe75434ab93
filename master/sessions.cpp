// How workers come.
#include "master/sessions.h"

#include <algorithm>
#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/redirect_error.hpp>

#include "common/net/until_first_ends.h"
#include "common/work/engine.h"
#include "master/session.h"

namespace rayfarm {
namespace {

using asio::ip::tcp;

constexpr std::chrono::milliseconds between_ticks{100};

}  // namespace

DialTarget parse_dial_target(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string_view::npos)
    throw AddressError("\"" + std::string(text) +
                       "\" is no worker to dial: write NAME=HOST or NAME=HOST:PORT");
  DialTarget target{std::string(text.substr(0, equals)),
                    parse_address(text.substr(equals + 1), default_farm_port)};
  if (target.address.port == 0) throw AddressError("no worker listens at port 0: write the one that it says");
  return target;
}

Sessions::Sessions(asio::io_context& io, LiveFarm& farm, const Address& listen, Security security,
                   DoorLimits limits, Access* access)
    : io_(io),
      farm_(farm),
      security_(std::move(security)),
      limits_(limits),
      access_(access),
      acceptor_(listen_at(io, listen, security_)),
      listening_at_{acceptor_.local_endpoint().address().to_string(), acceptor_.local_endpoint().port()},
      strangers_(std::make_shared<std::list<Stranger>>()),
      ended_(io, std::chrono::steady_clock::time_point::max()) {
  engine_fingerprint();  // rendered now, not while the first worker waits
}

Sessions::~Sessions() = default;

asio::awaitable<void> Sessions::run() { return until_first_ends(accept_all(), tick(), wait_until_stopped()); }

void Sessions::stop() {
  stopping_ = true;
  for (Session* session : sessions_) {
    session->connection.post(Goodbye{"the master stops"});
    session->connection.finish();
  }
  ended_.cancel();
}

asio::awaitable<void> Sessions::wait_until_stopped() {
  while (!stopping_ || !sessions_.empty()) {
    asio::error_code woken;
    co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
}

asio::awaitable<void> Sessions::accept_all() {
  for (;;) {
    tcp::socket socket = co_await accept(acceptor_);
    asio::co_spawn(io_, serve_stranger(std::move(socket)), asio::detached);
  }
}

/// The farm has no clock of its own.
asio::awaitable<void> Sessions::tick() {
  asio::steady_timer timer(io_);
  for (;;) {
    timer.expires_after(between_ticks);
    co_await timer.async_wait(asio::use_awaitable);
    farm_.tick();
  }
}

asio::awaitable<void> Sessions::serve_stranger(tcp::socket socket) {
  asio::error_code unknown;
  const tcp::endpoint peer = socket.remote_endpoint(unknown);
  auto attempt = try_stranger(std::move(socket));
  const std::string fault = co_await std::move(attempt);
  if (fault.empty()) co_return;
  const auto line = strangers_refused_.line_for("no worker at " + peer.address().to_string() + ": " + fault,
                                                std::chrono::steady_clock::now());
  if (line) farm_.note({true, *line, ""});
}

/// Why it was not admitted; empty when it was.
asio::awaitable<std::string> Sessions::try_stranger(tcp::socket socket) {
  Visit visit(*this, socket.native_handle());
  std::string fault;
  try {
    std::optional<Channel> channel;
    auto greeting = until_first_ends(receive(channel, std::move(socket)), wait_until_stopping());
    co_await std::move(greeting);
    if (!channel) co_return "";
    auto serving = serve(std::move(*channel), nullptr, &visit);
    fault = co_await std::move(serving);
  } catch (const ConnectionLost& error) {
    fault = error.what();
  }
  co_return fault;
}

asio::awaitable<void> Sessions::receive(std::optional<Channel>& channel, tcp::socket socket) {
  auto greeting = greet(std::move(socket), security_, limits_.connection.handshake);
  channel = co_await std::move(greeting);
}

asio::awaitable<void> Sessions::wait_until_stopping() {
  while (!stopping_) {
    asio::error_code woken;
    co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
}

void Sessions::dial(DialTarget target) {
  expect_free(target.name);
  const auto dialled = dialled_.insert(dialled_.end(), {std::move(target), asio::steady_timer(io_)});
  asio::co_spawn(io_, keep_dialled(dialled), asio::detached);
}

void Sessions::expect_free(const std::string& name) const {
  for (const Dialled& dialled : dialled_)
    if (dialled.is_wanted && dialled.target.name == name)
      throw NameInUse("\"" + name + "\" is dialled already, at " + text_of(dialled.target.address) +
                      ": stop that first (DELETE /api/v1/workers/dial/" + name + "), or choose another name");
  farm_.apply([&](Farm& farm, FarmTime) {
    for (const WorkerView& worker : farm.workers())
      if (worker.info.name == name)
        throw NameInUse("a worker \"" + name + "\" is here already; dial the new one by another name");
    if (const auto objection = farm.objection_to(name)) throw NameInUse(*objection);
  });
}

bool Sessions::stop_dialling(const std::string& name) {
  const auto is_meant = [&](const Dialled& d) { return d.is_wanted && d.target.name == name; };
  const auto dialled = std::ranges::find_if(dialled_, is_meant);
  if (dialled == dialled_.end()) return false;
  dialled->is_wanted = false;
  dialled->pause.cancel();
  return true;
}

std::vector<Dialling> Sessions::dialling() const {
  std::vector<Dialling> all;
  for (const Dialled& dialled : dialled_) {
    const auto is_reached = [&](const Session* s) { return s->dialled == &dialled && s->worker; };
    if (!dialled.is_wanted || std::ranges::any_of(sessions_, is_reached)) continue;
    all.push_back({dialled.target.name, text_of(dialled.target.address), dialled.fault});
  }
  return all;
}

asio::awaitable<void> Sessions::keep_dialled(std::list<Dialled>::iterator place) {
  Dialled& dialled = *place;
  Backoff backoff(limits_.backoff, std::random_device{}());
  while (!stopping_ && dialled.is_wanted) {
    const auto begun = std::chrono::steady_clock::now();
    auto attempt = try_target(dialled);
    const std::string fault = co_await std::move(attempt);
    // One that ends sooner is no success: a worker that lies at once is not dialled without pause.
    const bool lasted = std::chrono::steady_clock::now() - begun > limits_.backoff.longest;
    if (fault.empty() && lasted) backoff.reset();
    const std::string& name = dialled.target.name;
    if (!dialled.is_wanted) break;
    if (!fault.empty() && fault != dialled.fault)
      farm_.note({true, "worker \"" + name + "\": " + fault + "; trying again", name});
    dialled.fault = fault;
    dialled.pause.expires_after(backoff.next());
    asio::error_code woken;
    co_await dialled.pause.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
  dialled_.erase(place);
}

/// Why there was no worker; empty after one that there was has gone.
asio::awaitable<std::string> Sessions::try_target(const Dialled& dialled) {
  std::string fault;
  try {
    auto dialling = rayfarm::dial(dialled.target.address, security_, limits_.connection.handshake);
    Channel channel = co_await std::move(dialling);
    auto serving = serve(std::move(channel), &dialled, nullptr);
    fault = co_await std::move(serving);
  } catch (const AddressError& error) {
    fault = error.what();
  } catch (const ConnectionLost& error) {
    fault = error.what();
  }
  co_return fault;
}

}  // namespace rayfarm
