#include "worker/worker.h"

#include <spdlog/spdlog.h>

#include <asio/co_spawn.hpp>
#include <asio/detached.hpp>
#include <asio/redirect_error.hpp>

#include "common/net/until_first_ends.h"

namespace rayfarm {

using asio::ip::tcp;

WorkerDaemon::WorkerDaemon(asio::io_context& io, WorkerOptions options, PrepareScene prepare)
    : io_(io),
      options_(std::move(options)),
      crew_(options_.identity.threads, std::move(prepare)),
      backoff_(options_.backoff, std::random_device{}()),
      ended_(io, std::chrono::steady_clock::time_point::max()) {
  if (const auto* await = std::get_if<AwaitMaster>(&options_.way))
    acceptor_ = listen_at(io, await->listen, options_.security);
}

std::optional<Address> WorkerDaemon::listening_at() const {
  if (!acceptor_) return std::nullopt;
  const tcp::endpoint endpoint = acceptor_->local_endpoint();
  return Address{endpoint.address().to_string(), endpoint.port()};
}

asio::awaitable<void> WorkerDaemon::run() {
  const auto* dialling = std::get_if<DialMaster>(&options_.way);
  return until_first_ends(dialling ? keep_dialling(dialling->master) : await_masters(), wait_until_stopped());
}

void WorkerDaemon::stop() {
  stopping_ = true;
  if (session_) session_->stop();
  ended_.cancel();
}

asio::awaitable<void> WorkerDaemon::wait_until_stopped() {
  while (!stopping_ || session_) {
    asio::error_code woken;
    co_await ended_.async_wait(asio::redirect_error(asio::use_awaitable, woken));
  }
  spdlog::info("stopped");
}

/// One line for each thing that went wrong, not for each attempt.
void WorkerDaemon::report(const std::string& loss) {
  if (loss != last_loss_) spdlog::warn("{}; trying again", loss);
  last_loss_ = loss;
}

// A worker that dials. -------------------------------------------------------------------------------------

asio::awaitable<void> WorkerDaemon::keep_dialling(Address master) {
  asio::steady_timer timer(io_);
  while (!stopping_) {
    auto attempt = try_master(master);
    co_await std::move(attempt);
    timer.expires_after(backoff_.next());
    co_await timer.async_wait(asio::use_awaitable);
  }
}

asio::awaitable<void> WorkerDaemon::try_master(Address master) {
  try {
    auto dialling = dial(master, options_.security, options_.times.connection.handshake);
    Channel channel = co_await std::move(dialling);
    auto talking = talk(std::move(channel));
    co_await std::move(talking);
  } catch (const ExposureError&) {
    throw;
  } catch (const AddressError& error) {
    report(error.what());
  } catch (const ConnectionLost& error) {
    report(error.what());
  }
}

// A worker that is dialled. --------------------------------------------------------------------------------

asio::awaitable<void> WorkerDaemon::await_masters() {
  for (;;) {
    tcp::socket socket = co_await accept(*acceptor_);
    asio::co_spawn(io_, serve_stranger(std::move(socket)), asio::detached);
  }
}

asio::awaitable<void> WorkerDaemon::serve_stranger(tcp::socket socket) {
  asio::error_code unknown;
  const std::string address = socket.remote_endpoint(unknown).address().to_string();
  try {
    auto greeting = greet(std::move(socket), options_.security, options_.times.connection.handshake);
    Channel channel = co_await std::move(greeting);
    if (channel.is_encrypted() && !channel.peer()) throw ConnectionLost("it showed no certificate");
    auto conversation = session_ ? decline(std::move(channel)) : talk(std::move(channel));
    co_await std::move(conversation);
  } catch (const ConnectionLost& error) {
    const auto line = strangers_refused_.line_for("no master at " + address + ": " + error.what(),
                                                  std::chrono::steady_clock::now());
    if (line) spdlog::warn("{}", *line);
  }
}

asio::awaitable<void> WorkerDaemon::decline(Channel channel) {
  MasterConnection connection(std::move(channel), options_.times.connection);
  connection.post(Goodbye{"this worker works for another master"});
  connection.finish();
  co_await connection.tend();
}

// Both. ----------------------------------------------------------------------------------------------------

asio::awaitable<void> WorkerDaemon::talk(Channel channel) {
  const auto session =
      std::make_shared<WorkerSession>(std::move(channel), options_.identity, crew_, options_.times);
  session_ = session;
  const auto begun = std::chrono::steady_clock::now();
  if (stopping_) session->stop();
  std::string loss;
  try {
    co_await session->run();
  } catch (const std::exception& error) {
    loss = error.what();
  }
  // One that ends sooner is no success: a master that throws us out at once is not dialled without pause.
  const bool lasted = std::chrono::steady_clock::now() - begun > options_.backoff.longest;
  if (session->was_welcomed() && lasted) {
    backoff_.reset();
    last_loss_.clear();
  }
  if (!loss.empty() && !stopping_)
    report("no longer connected to the master at " + session->peer() + ": " + loss);
  if (stopping_)
    crew_.abandon();
  else
    crew_.lose_master();
  session_.reset();
  ended_.cancel();
}

}  // namespace rayfarm
