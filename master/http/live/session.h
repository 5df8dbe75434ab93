// The live connection, /api/v1/live: a WebSocket on which viewers watch jobs, workers and pictures.
//
//   viewer -> master   text     which layers it watches: {"watch": [...]}; 4 KB at most
//   master -> viewer   text     state, log, layer: json.h
//   master -> viewer   binary   a tile of a watched layer: tile_message.h
// A viewer is sent the next message when the last one has gone out. One that takes nothing for 60 s, or whose
// PC is silent, is left.
#pragma once
#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>
#include <chrono>
#include <functional>
#include <set>

#include "master/http/http_stream.h"
#include "master/http/live/hub.h"
#include "master/http/live/reporter.h"

namespace rayfarm {

constexpr std::string_view live_path = "/api/v1/live";

class LiveSessions {
 public:
  /// Looks things up on `threads`. `patience`: with a viewer that takes nothing. What runs in `io` and in
  /// `threads` must be gone before this is.
  LiveSessions(boost::asio::io_context& io, boost::asio::thread_pool& threads, const Doors& doors,
               std::chrono::milliseconds patience);

  /// Talks with a viewer until it ends, or may no longer stay. The request asks for the upgrade, and may.
  boost::asio::awaitable<void> serve(HttpStream stream,
                                     boost::beast::http::request<boost::beast::http::string_body> request,
                                     std::function<bool()> may_stay);

 private:
  struct Session;

  boost::asio::awaitable<void> read_all(Session& session);
  boost::asio::awaitable<void> write_all(std::shared_ptr<Session> session);
  boost::asio::awaitable<void> say_why(Session& session, std::string reason);
  boost::asio::awaitable<void> report();
  boost::asio::awaitable<LiveNews> look_up(LiveWish wish);
  void watch(Session& session, const std::string& text);
  void leave_some();

  boost::asio::io_context& io_;
  boost::asio::thread_pool& threads_;
  const std::chrono::milliseconds patience_;
  LiveHub hub_;
  LiveReporter reporter_;
  std::set<Session*> sessions_;
  bool is_reporting_ = false;
};

}  // namespace rayfarm
