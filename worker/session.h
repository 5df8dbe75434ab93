// One conversation with a master, whoever dialled.
#pragma once
#include <memory>
#include <optional>
#include <set>

#include "common/net/connection.h"
#include "common/work/crew.h"

namespace rayfarm {

/// Who this worker says it is.
struct WorkerIdentity {
  std::string name, cpu;
  std::uint32_t threads = 1;
  std::uint64_t process = 0;  // see Hello
};

/// Throws std::invalid_argument unless the master can take it.
void check(const WorkerIdentity& identity);

struct SessionTimes {
  ConnectionTimes connection;
  std::chrono::milliseconds to_finish{5000};  // what is begun, at a clean stop
};

class WorkerSession : public std::enable_shared_from_this<WorkerSession> {
 public:
  WorkerSession(Channel channel, WorkerIdentity identity, Crew& crew, SessionTimes times);

  /// The whole conversation. Returns when the master said goodbye or we did; throws why it ended otherwise.
  asio::awaitable<void> run();
  /// Gives back what is not begun, delivers what is, within `to_finish`; then says goodbye.
  void stop();

  const std::string& peer() const { return connection_.peer(); }
  /// The master has taken us in.
  bool was_welcomed() const { return welcomed_; }

 private:
  asio::awaitable<void> converse();
  asio::awaitable<void> wait_for_end_of_patience();
  void handle(const ToWorker& message);
  void offer_kept(const Versions& spoken);
  void answer(const ToMaster& message);
  void leave_when_done();
  void leave();

  MasterConnection connection_;
  WorkerIdentity identity_;
  Crew& crew_;
  SessionTimes times_;
  asio::steady_timer patience_;  // expires when a clean stop has taken too long
  std::set<LeaseId> held_;       // assigned, and not ended yet
  bool welcomed_ = false, stopping_ = false;
};

}  // namespace rayfarm
