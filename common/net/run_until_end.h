// A program, or a test's thread, whose whole life is one coroutine.
#pragma once
#include <asio/awaitable.hpp>
#include <asio/co_spawn.hpp>
#include <asio/io_context.hpp>
#include <exception>

namespace rayfarm {

/// Runs everything in io until `life` ends; throws what it threw.
inline void run_until_end(asio::io_context& io, asio::awaitable<void> life) {
  std::exception_ptr failure;
  asio::co_spawn(io, std::move(life), [&](std::exception_ptr error) {
    failure = error;
    io.stop();
  });
  io.run();
  if (failure) std::rethrow_exception(failure);
}

}  // namespace rayfarm
