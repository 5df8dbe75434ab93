// The master's own threads, a worker of the farm without a network between.
#pragma once
#include <asio/io_context.hpp>
#include <memory>

#include "common/work/crew.h"
#include "master/live_farm.h"

namespace rayfarm {

class LocalThreads {
 public:
  /// Works from now on, while `io` runs: that is the farm's thread.
  LocalThreads(asio::io_context& io, LiveFarm& farm, unsigned threads, PrepareScene prepare = prepare_scene);
  /// Leaves the farm.
  ~LocalThreads();

 private:
  LiveFarm& farm_;
  std::shared_ptr<const WorkerId> id_;  // answers on their way hold it weakly: they may come too late
  Crew crew_;
};

}  // namespace rayfarm
