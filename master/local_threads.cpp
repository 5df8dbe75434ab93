#include "master/local_threads.h"

#include <asio/post.hpp>

#include "common/daemon/system.h"
#include "master/hand_in.h"

namespace rayfarm {

LocalThreads::LocalThreads(asio::io_context& io, LiveFarm& farm, unsigned threads, PrepareScene prepare)
    : farm_(farm), crew_(threads, std::move(prepare)) {
  WorkerInfo info{"master", "this PC", cpu_name(), RAYFARM_VERSION, threads, WorkerKind::local};
  info.takes_pieces = true;
  const auto send = [this](const ToWorker& message) {
    std::visit(
        [this](const auto& m) {
          if constexpr (requires { crew_.take(m); }) crew_.take(m);
        },
        message);
  };
  const auto id = std::make_shared<WorkerId>();
  crew_.begin([&io, &farm, id = std::weak_ptr<const WorkerId>(id)](ToMaster message) {
    asio::post(io, [&farm, id, message = std::move(message)]() mutable {
      if (const auto worker = id.lock()) hand_in(farm, *worker, std::move(message));
    });
  });
  *id = farm_.apply([&](Farm& f, FarmTime now) { return f.add_worker(info, send, now); });
  id_ = id;
}

LocalThreads::~LocalThreads() {
  farm_.apply([this](Farm& farm, FarmTime now) {
    farm.receive(*id_, GiveBack{}, now);  // it is not lost, it stops
    farm.remove_worker(*id_, "the master stops", now);
  });
}

}  // namespace rayfarm
