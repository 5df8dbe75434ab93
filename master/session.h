// What Sessions has in memory of those it talks with.
#pragma once
#include <algorithm>
#include <list>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "master/sessions.h"

namespace rayfarm {

struct Sessions::Session {
  WorkerConnection connection;
  const Dialled* dialled;          // null: it came by itself
  Visit* visit;                    // until it is a worker; null: it was dialled
  std::optional<WorkerId> worker;  // once it is admitted
  std::string farewell;            // what it said when it went

  const std::optional<PeerCertificate>& certificate() const { return connection.channel().peer(); }
  /// Encrypted, and it has shown no certificate: it may ask for one, and for nothing else.
  bool is_strangers() const { return connection.channel().is_encrypted() && !certificate(); }
};

/// A stranger's, from when it is accepted until it has gone or is a worker.
class Sessions::Visit {
 public:
  Visit(Sessions& sessions, int socket)
      : all_(sessions.strangers_), place_(all_->insert(all_->end(), {OpenSocket(socket)})) {
    const auto oldest = std::ranges::find_if(*all_, [](const Stranger& s) { return !s.is_leaving; });
    if (all_->size() <= sessions.limits_.strangers) return;
    oldest->is_leaving = true;
    oldest->socket.shut_down();
  }
  ~Visit() { end(); }
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;
  void end() {
    if (place_) all_->erase(*std::exchange(place_, std::nullopt));
  }

 private:
  const std::shared_ptr<std::list<Stranger>> all_;
  std::optional<std::list<Stranger>::iterator> place_;
};

struct Sessions::Dialled {
  DialTarget target;
  asio::steady_timer pause;  // between two tries
  std::string fault{};       // of the last try
  bool is_wanted = true;     // else it goes when its try has ended
};

}  // namespace rayfarm
