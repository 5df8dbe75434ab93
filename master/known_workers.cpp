// Who workers are, whatever they call themselves, and who is not let in.
#include <algorithm>
#include <utility>

#include "master/farm_state.h"

namespace rayfarm {
namespace {

std::string words_for_banned(std::string_view name) {
  return "worker " + std::string(name) + " is banned from this farm; rayfarm unban " + std::string(name) +
         " lets it in again";
}

}  // namespace

void Farm::State::meet(const Worker& worker) {
  if (worker.info.kind == WorkerKind::local) return;
  std::vector<NameId>& its_names = known_workers[worker.identity].names;
  if (!its_names.empty() && its_names.back() == worker.name) return;
  std::erase(its_names, worker.name);
  its_names.push_back(worker.name);
  record_known(worker.identity);
}

Worker* Farm::State::worker_here(WorkerId id) {
  const auto here = workers.find(id);
  return here == workers.end() ? nullptr : &here->second;
}

std::map<LeaseId, Lease> Farm::State::end_former_connection(const std::string& identity,
                                                            std::uint64_t process, FarmTime now) {
  const auto former = std::ranges::find_if(workers, [&](const auto& w) {
    return w.second.info.kind == WorkerKind::remote && w.second.identity == identity &&
           w.second.info.process == process;
  });
  if (process == 0 || former == workers.end()) return {};
  Worker& worker = former->second;
  const std::size_t given_back = end_leases(worker, now).size();
  tell("worker " + worker.info.name + " comes again while its old connection is still here; " +
           count_of_tiles(given_back) + " given back",
       worker.info.name);
  worker.send(Goodbye{"you are here on another connection"});
  std::map<LeaseId, Lease> leases = std::move(worker.called_off);
  workers.erase(former);
  return leases;
}

void Farm::State::record_known(const std::string& identity) {
  const KnownWorker& known = known_workers.at(identity);
  record(WorkerKnown{identity, names[static_cast<std::size_t>(known.names.back())], known.is_banned,
                     known.trust});
}

std::vector<std::string> Farm::State::identities_of(std::string_view name) const {
  if (const Worker* worker = worker_named(name)) return {worker->identity};
  std::vector<std::string> identities;
  for (const auto& [identity, known] : known_workers)
    if (names[static_cast<std::size_t>(known.names.back())] == name) identities.push_back(identity);
  return identities;
}

bool Farm::ban(std::string_view name, FarmTime now) {
  const Worker* worker = state_->worker_named(name);
  const auto was_here = state_->name_ids.find(std::string(name));
  if (was_here == state_->name_ids.end() || (worker && worker->info.kind == WorkerKind::local)) return false;
  state_->ban(was_here->first, now);
  state_->fill_all(now);
  return true;
}

void Farm::State::ban(const std::string& name, FarmTime now) {
  if (banned_names.insert(name).second) {
    tell("worker " + name + " banned", name);
    record(WorkerBanned{name, true});
  }
  for (const std::string& identity : identities_of(name)) {
    for (auto& [id, worker] : workers)
      if (worker.identity == identity && worker.info.kind == WorkerKind::remote) turn_away(worker, name, now);
    strike_opinions(identity, now);
    const auto known = known_workers.find(identity);
    if (known == known_workers.end() || std::exchange(known->second.is_banned, true)) continue;
    record_known(identity);
  }
}

void Farm::State::turn_away(Worker& worker, const std::string& name, FarmTime now) {
  end_leases(worker, now);
  worker.is_stopping = true;
  worker.send(Refused{words_for_banned(name)});
}

bool Farm::unban(std::string_view name, FarmTime) {
  const auto banned = state_->banned_names.find(name);
  if (banned == state_->banned_names.end()) return state_->worker_named(name) != nullptr;
  state_->tell("worker " + *banned + " no longer banned", *banned);
  state_->record(WorkerBanned{*banned, false});
  for (const std::string& identity : state_->identities_of(name)) {
    const auto known = state_->known_workers.find(identity);
    if (known == state_->known_workers.end()) continue;
    known->second.is_banned = false, known->second.trust = {};
    state_->record_known(identity);
  }
  state_->banned_names.erase(banned);
  return true;
}

std::optional<std::string> Farm::objection_to(const std::string& wanted_name,
                                              const std::string& certificate) const {
  const auto known = state_->known_workers.find(identity_of(wanted_name, certificate));
  if (known != state_->known_workers.end() && known->second.is_banned)
    return words_for_banned(state_->names[static_cast<std::size_t>(known->second.names.back())]);
  const bool is_new =
      known == state_->known_workers.end() || !state_->name_ids.contains(state_->unique_name(wanted_name));
  if (is_new &&
      std::max(state_->known_workers.size(), state_->name_ids.size()) >= state_->limits.worker_names)
    return "this farm has known " + std::to_string(state_->limits.worker_names) +
           " workers and takes in no new one; give this PC a --name that one of them had";
  if (is_new && known != state_->known_workers.end() &&
      known->second.names.size() >= state_->limits.names_of_one)
    return "workers with this certificate have had " + std::to_string(state_->limits.names_of_one) +
           " names and get no new one; give this one a --name that one of them had";
  for (const std::string& name : {wanted_name, state_->unique_name(wanted_name)})
    if (state_->banned_names.contains(name)) return words_for_banned(name);
  return std::nullopt;
}

std::vector<std::string> Farm::banned() const {
  return {state_->banned_names.begin(), state_->banned_names.end()};
}

Trust Farm::trust_in(std::string_view name) const {
  const std::vector<std::string> identities = state_->identities_of(name);
  const auto known =
      identities.empty() ? state_->known_workers.end() : state_->known_workers.find(identities.front());
  return known == state_->known_workers.end() ? Trust{} : known->second.trust;
}

}  // namespace rayfarm
