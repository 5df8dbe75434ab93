#include "master/diagnostics/background.h"

#include <sys/resource.h>
#include <unistd.h>

#include <new>

namespace rayfarm {
namespace {

void take_lowest_priority() { setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 19); }

}  // namespace

std::chrono::nanoseconds steady_now() { return std::chrono::steady_clock::now().time_since_epoch(); }

class Background::Task {
 public:
  explicit Task(Work work) : work(std::move(work)) {}

  Work work;
  std::atomic<std::chrono::nanoseconds> asked{std::chrono::nanoseconds::min()};
  std::uint64_t question = 0;  // number of the last one; 0: none yet
  std::uint32_t begun = 0, done = 0;
  std::vector<std::uint32_t> undone;  // begun, to be begun again
  std::string fault;

  bool is_over() const { return done == work.parts || !fault.empty(); }
  bool has_waiting() const { return !is_over() && (begun < work.parts || !undone.empty()); }
  std::uint32_t take_part() {
    if (undone.empty()) return begun++;
    const std::uint32_t part = undone.back();
    undone.pop_back();
    return part;
  }
};

Background::Background(unsigned threads, Clock now) : now_(std::move(now)) {
  for (unsigned i = 0; i < threads; ++i)
    threads_.emplace_back([this] {
      take_lowest_priority();
      work();
    });
}

Background::~Background() { stop(); }

void Background::stop() {
  const Lock lock(mutex_);
  ending_ = true;
  news_.notify_all();
}

Background::TaskRef Background::add(Work work) {
  const auto task = std::make_shared<Task>(std::move(work));
  const Lock lock(mutex_);
  std::erase_if(tasks_, [](const auto& known) { return known.expired(); });
  tasks_.push_back(task);
  return task;
}

Standing Background::ask(const TaskRef& task) {
  const Lock lock(mutex_);
  if (!is_wanted(*task)) task->fault.clear();  // what failed before others is tried again
  task->asked = now_();
  task->question = ++questions_;
  if (task->has_waiting()) news_.notify_all();
  if (!task->fault.empty()) return {LayerProgress::failed, 0, task->fault};
  const double share = task->work.parts == 0 ? 1 : static_cast<double>(task->done) / task->work.parts;
  return {task->is_over() ? LayerProgress::done : LayerProgress::making, share, {}};
}

bool Background::work_once() {
  Lock lock(mutex_);
  std::optional<Part> part = next_part();
  if (!part) return false;
  do_part(lock, std::move(*part));
  return true;
}

void Background::work() {
  Lock lock(mutex_);
  while (!ending_)
    if (std::optional<Part> part = next_part())
      do_part(lock, std::move(*part));
    else
      news_.wait(lock);
}

bool Background::is_wanted(const Task& task) const {
  return task.question != 0 && now_() - task.asked.load() < interest_lasts;
}

std::optional<Background::Part> Background::next_part() {
  TaskRef next;
  for (const auto& known : tasks_)
    if (const TaskRef task = known.lock(); task && task->has_waiting() && is_wanted(*task))
      if (!next || task->question > next->question) next = task;
  if (!next) return std::nullopt;
  return Part{next, next->take_part()};
}

/// The lock is open while the part is done, and while a task that nobody wants any more is freed.
void Background::do_part(Lock& lock, Part part) {
  Task& task = *part.task;
  bool is_done = false;
  std::string fault;
  lock.unlock();
  try {
    is_done = task.work.do_part(part.number,
                                [&] { return ending_ || now_() - task.asked.load() >= interest_lasts; });
  } catch (const std::bad_alloc&) {
    fault = "the master has no memory for it";
  } catch (const std::exception& error) {
    fault = error.what();
  }
  lock.lock();
  if (is_done && ++task.done == task.work.parts) task.work.do_part = nullptr;  // with what it holds
  if (!is_done) task.undone.push_back(part.number);
  if (!fault.empty()) task.fault = std::move(fault);
  lock.unlock();
  part.task.reset();
  lock.lock();
}

}  // namespace rayfarm
