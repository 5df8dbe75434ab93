// Who is connected, so that nobody holds all there is room for.
#pragma once
#include <list>
#include <string>

#include "common/net/open_socket.h"
#include "master/http/http_stream.h"

namespace rayfarm {

/// Connections that nobody would miss, most of which wait for a request; the one that has waited longest first.
using IdleConnections = std::list<HttpStream*>;

class IdleTime {
 public:
  IdleTime(IdleConnections& all, HttpStream& stream) : all_(all), place_(all.insert(all.end(), &stream)) {}
  ~IdleTime() { all_.erase(place_); }
  IdleTime(const IdleTime&) = delete;
  IdleTime& operator=(const IdleTime&) = delete;

 private:
  IdleConnections& all_;
  const IdleConnections::iterator place_;
};

struct Guest {
  OpenSocket socket;
  std::string who{};        // what they showed, or their address; empty: nobody yet
  bool is_leaving = false;  // it was told to, and will be gone soon
};

/// All connections.
class Guests {
 public:
  /// Of one, from its coming to its end.
  class Stay {
   public:
    Stay(Guests& guests, int socket)
        : guests_(guests), place_(guests.all_.insert(guests.all_.end(), {OpenSocket(socket)})) {}
    ~Stay() { guests_.all_.erase(place_); }
    Stay(const Stay&) = delete;
    Stay& operator=(const Stay&) = delete;
    Guest& guest() const { return *place_; }

   private:
    Guests& guests_;
    const std::list<Guest>::iterator place_;
  };

  std::size_t count() const { return all_.size(); }
  /// Tells the oldest connection of those to go who have most of them; false when all were told already.
  bool send_away_one();

 private:
  std::list<Guest> all_;  // the oldest first
};

}  // namespace rayfarm
