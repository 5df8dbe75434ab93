// Loops that run together until one of them ends.
#pragma once
#include <array>
#include <asio/awaitable.hpp>
#include <asio/co_spawn.hpp>
#include <asio/experimental/deferred.hpp>
#include <asio/experimental/parallel_group.hpp>
#include <asio/this_coro.hpp>
#include <asio/use_awaitable.hpp>
#include <exception>
#include <tuple>

namespace rayfarm {

/// Runs all loops; when the first ends, the others are cancelled and waited for. What the first threw is
/// thrown on. Asio's own || waits for the first that succeeds, and && reports the cancelled ones instead of
/// the cause.
template <class... Loops>
asio::awaitable<void> until_first_ends(Loops... loops) {
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  auto group = asio::experimental::make_parallel_group(
      asio::co_spawn(executor, std::move(loops), asio::experimental::deferred)...);
  const auto results = co_await group.async_wait(asio::experimental::wait_for_one(), asio::use_awaitable);
  const std::exception_ptr cause = std::apply(
      [](const auto& order, const auto&... exceptions) { return std::array{exceptions...}[order[0]]; },
      results);
  if (cause) std::rethrow_exception(cause);
}

}  // namespace rayfarm
