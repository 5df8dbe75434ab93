#include "tests/master/farm/fake_worker.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace rayfarm {

float made_up_value(FrameId frame, std::uint32_t x, std::uint32_t y, int channel) {
  return static_cast<float>(static_cast<std::uint64_t>(frame.job) * 3 + frame.frame * 31 + x * 7 + y * 1013) +
         0.25f * static_cast<float>(channel);
}

namespace {

Result rendered_area(const Assignment& assignment, const Tile& area, double seconds) {
  Result result{assignment.lease, assignment.job, assignment.frame, assignment.tile, {}, seconds};
  for (int pass = 0; pass < pass_count; ++pass) {
    if (!(assignment.passes & 1u << pass)) continue;
    PassImage image{.pass = pass, .rgb = {}, .counters = {}};
    for_each_pixel(area, pass, [&](std::uint32_t x, std::uint32_t y) {
      for (int c = 0; c < 3; ++c)
        image.rgb.push_back(made_up_value({assignment.job, assignment.frame}, x, y, c));
      image.counters.primary += 1;
      image.counters.shadow += x;
    });
    result.images.push_back(std::move(image));
  }
  return result;
}

}  // namespace

Result rendered(const Assignment& assignment, Size film, double seconds) {
  return rendered_area(assignment, tile_at(film, assignment.tile), seconds);
}

PieceResult rendered_piece(const HeldAssignment& assignment, double seconds) {
  return {rendered_area(assignment, assignment.piece.value(), seconds), *assignment.piece};
}

ZeroedVector<float> made_up_picture(JobId job, Size film, std::uint32_t frame) {
  ZeroedVector<float> picture;
  for (std::uint32_t y = 0; y < film.height; ++y)
    for (std::uint32_t x = 0; x < film.width; ++x)
      for (int c = 0; c < 3; ++c) picture.push_back(made_up_value({job, frame}, x, y, c));
  return picture;
}

RayCounters made_up_counters(Size film) {
  RayCounters counters;
  counters.primary = std::uint64_t{film.width} * film.height;
  counters.shadow = std::uint64_t{film.width} * (film.width - 1) / 2 * film.height;
  return counters;
}

JobSpec job_of(Size film, std::string name, std::string scene_hash) {
  JobSpec spec;
  spec.name = std::move(name);
  spec.scene_hash = std::move(scene_hash);
  spec.scene_bytes = std::make_shared<const std::vector<std::uint8_t>>(3, std::uint8_t{7});
  spec.settings.width = film.width;
  spec.settings.height = film.height;
  return spec;
}

bool add_frame(Farm& farm, JobId job, std::uint32_t frame, FarmTime now) {
  auto scene = std::make_shared<const std::vector<std::uint8_t>>(3, std::uint8_t{7});
  return farm.add_frame({job, frame}, "scene " + std::to_string(frame), std::move(scene), now);
}

struct FakeWorker::Desk {
  bool takes_pieces = false;
  std::vector<ToWorker> messages;
  std::vector<HeldAssignment> held;
  std::map<JobId, Size> jobs;

  void take(ToWorker message) {
    if (const auto* assignment = std::get_if<Assignment>(&message)) {
      held.push_back({*assignment});
    } else if (const auto* piece = std::get_if<PieceAssignment>(&message)) {
      if (!takes_pieces) throw std::logic_error("a piece of a tile for who takes none");
      held.push_back({piece->work, piece->area});
    } else if (const auto* revoke = std::get_if<Revoke>(&message)) {
      for (const LeaseId lease : revoke->leases)
        std::erase_if(held, [&](auto& a) { return a.lease == lease; });
    } else {
      if (const auto* job = std::get_if<FrameStart>(&message))
        jobs[job->job] = {job->settings.width, job->settings.height};
      messages.push_back(std::move(message));
    }
  }
};

FakeWorker::FakeWorker(Farm& farm, WorkerInfo info, FarmTime now)
    : farm_(&farm), desk_(std::make_shared<Desk>()) {
  desk_->takes_pieces = info.takes_pieces;
  id_ = farm.add_worker(
      std::move(info), [desk = desk_](ToWorker m) { desk->take(std::move(m)); }, now);
}

std::vector<ToWorker> FakeWorker::take_messages() { return std::exchange(desk_->messages, {}); }

const std::vector<HeldAssignment>& FakeWorker::held() const { return desk_->held; }

void FakeWorker::finish_one(FarmTime now, double seconds) {
  const HeldAssignment first = desk_->held.at(0);
  drop(first.lease);
  if (first.piece)
    farm_->receive(id_, rendered_piece(first, seconds), now);
  else
    farm_->receive(id_, rendered(first, desk_->jobs.at(first.job), seconds), now);
}

void FakeWorker::finish_all(FarmTime now) {
  while (!held().empty()) finish_one(now);
}

void FakeWorker::drop(LeaseId lease) {
  std::erase_if(desk_->held, [&](const Assignment& a) { return a.lease == lease; });
}

std::string FakeWorker::name() const { return farm_->name_of_worker(id_); }

}  // namespace rayfarm
