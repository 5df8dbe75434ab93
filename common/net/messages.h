// What a master and a worker say to each other.
//
// The conversation; either side may have dialled.
//   worker -> master  Hello         who I am, what I speak; the first frame, within 5 s
//   master -> worker  Welcome       you are in (a name already taken is made unique), and we speak this    or
//   master -> worker  Refused       why, and what to do; the connection ends
//   master -> worker  AssetData     once per mesh, Bezier surface or image and worker, before the first scene with it
//   master -> worker  SceneData     once per scene and worker, before the first frame that shows it
//   master -> worker  FrameStart    settings for a frame of a job, whose scene and assets were already sent
//   master -> worker  Assignment    render these passes of this tile
//   worker -> master  Result        the passes, pixel for pixel, with their exact counters; ends the lease
//   worker -> master  GiveBack      leases it will not finish: clean stop, or it cannot render the job (why)
//   master -> worker  PieceAssignment  the same of a piece of a tile, when both can share tiles
//   worker -> master  PieceResult   its pixels and counters; a piece is not kept over the end of a conversation
//   master -> worker  Revoke        stop these leases now; nothing is answered for them
//   master -> worker  FrameEnd      forget the frame, and its scene when no other frame of it is left
//   master -> worker  AssetEnd      forget these assets: no job that goes on has them
//   worker -> master  Holds         after Welcome, when both can re-attach: what it has of conversations that were cut off,
//                                   rendered or being rendered, by the leases of then
//   master -> worker  Assignment    for what of that is still to be done: the worker goes on with it
//   master -> worker  Unneeded      the rest, by its old leases: forget it
//   both              Heartbeat     each 0.5 s while nothing else is said; 2 s of silence end the connection
//   both              Goodbye       a clean end, with the reason
// A PC becomes a worker over an encrypted connection on which it has shown no certificate:
//   PC -> master      Join          a pairing code, and a request for a certificate; instead of Hello
//   master -> PC      Paired        the certificate                                          or
//   master -> PC      Refused       another version is needed. A bad code is answered by closing the connection
// A job has one frame or, when it is an animation, several; what a worker knows, it knows of a frame.
// A lease is good for exactly one Result. The master drops what comes for a lease it has revoked (after
// comparing the pixels with those that another worker delivered).
#pragma once
#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/render/film.h"
#include "common/render/settings.h"

namespace rayfarm {

/// The newest that is spoken. Raised whenever the bytes of a message change their meaning; frames of each one that was
/// released stay in tests/common/net/golden.
constexpr std::uint16_t protocol_version = 4;
/// The oldest that is still spoken: those before were never released.
constexpr std::uint16_t oldest_protocol_version = 4;
constexpr std::uint16_t default_farm_port = 5411;
constexpr auto heartbeat_interval = std::chrono::milliseconds(500);
constexpr auto peer_patience = std::chrono::seconds(2);       // four missed heartbeats
constexpr auto handshake_patience = std::chrono::seconds(5);  // for Hello and for Welcome

enum class JobId : std::uint64_t {};
enum class LeaseId : std::uint64_t {};

/// One picture of a job.
struct FrameId {
  JobId job{};
  std::uint32_t frame = 0;
  auto operator<=>(const FrameId&) const = default;
};

// What one may know and another not: a bit each.
constexpr std::uint64_t can_reattach = 1;     // Holds, Unneeded
constexpr std::uint64_t can_take_pieces = 2;  // PieceAssignment, PieceResult

/// What a side speaks. Both use the newest protocol, and the capabilities, that they have in common.
struct Versions {
  std::uint16_t newest = protocol_version, oldest = oldest_protocol_version;
  std::uint64_t capabilities = can_reattach | can_take_pieces;
  bool operator==(const Versions&) const = default;
};
/// None when there is no protocol that both speak.
std::optional<Versions> common_versions(const Versions& a, const Versions& b);

struct Hello {
  Versions versions{};
  std::string software;  // its version, for people
  std::string name;
  std::string cpu;
  std::uint32_t threads = 1;
  std::string engine;  // engine_fingerprint(): SHA-256, hexadecimal
  std::uint64_t process =
      0;  // drawn at the program's start: by it a worker is known that has only lost the network
  bool operator==(const Hello&) const = default;
};
struct Welcome {
  std::string name;     // as the master will call this worker
  Versions versions{};  // that are spoken from now on: newest and oldest are one
  bool operator==(const Welcome&) const = default;
};
struct Join {
  Versions versions{};
  std::string software;
  std::string secret;                 // of the pairing code
  std::string name;                   // that the farm shall know this worker by
  std::vector<std::uint8_t> request;  // certificate_request()
  bool operator==(const Join&) const = default;
};
struct Paired {
  std::vector<std::uint8_t> certificate;  // PEM
  bool operator==(const Paired&) const = default;
};
struct Refused {
  std::string reason;
  bool operator==(const Refused&) const = default;
};
/// Encoded scenes are shared, never copied: one buffer for all workers.
using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;
struct SceneData {
  std::string hash;   // SHA-256 of the bytes, hexadecimal
  SharedBytes bytes;  // encode_scene()
};
/// A part of scenes that travels by itself.
struct AssetData {
  std::string hash;   // SHA-256 of the bytes, hexadecimal
  SharedBytes bytes;  // of asset_data()
};
struct AssetEnd {
  std::vector<std::string> hashes;
  bool operator==(const AssetEnd&) const = default;
};
struct FrameStart {
  JobId job{};
  std::string scene_hash;
  RenderSettings settings;            // they name the frame
  std::vector<std::string> assets{};  // hashes of those that the scene shows
  bool operator==(const FrameStart&) const = default;
};
struct Assignment {
  LeaseId lease{};
  JobId job{};
  std::uint32_t frame = 0;
  std::uint32_t tile = 0;
  PassSet passes = 0;
  bool operator==(const Assignment&) const = default;
};
struct Result {
  LeaseId lease{};
  JobId job{};
  std::uint32_t frame = 0;
  std::uint32_t tile = 0;
  std::vector<PassImage> images;
  double seconds = 0;  // of one thread, wall time
  bool operator==(const Result&) const = default;
};
/// Of the tile only this area, which is given in pixels of the film: a piece whose corner lies on the grid of the tile's
/// coarsest pass.
struct PieceAssignment {
  Assignment work;
  Tile area{};
  bool operator==(const PieceAssignment&) const = default;
};
struct PieceResult {
  Result result;  // the passes hold the area's pixels
  Tile area{};
  bool operator==(const PieceResult&) const = default;
};
/// Work of a lease that ended with its conversation.
struct HeldTile {
  Assignment work;
  bool is_finished = false;
  bool operator==(const HeldTile&) const = default;
};
struct Holds {
  std::vector<HeldTile> tiles;
  bool operator==(const Holds&) const = default;
};
struct Unneeded {
  std::vector<LeaseId> leases;
  bool operator==(const Unneeded&) const = default;
};
struct GiveBack {
  std::vector<LeaseId> leases;
  std::string reason;  // why it cannot render the jobs of these leases; empty: it is stopping
  bool operator==(const GiveBack&) const = default;
};
struct Revoke {
  std::vector<LeaseId> leases;
  bool operator==(const Revoke&) const = default;
};
struct FrameEnd {
  JobId job{};
  std::uint32_t frame = 0;
  bool operator==(const FrameEnd&) const = default;
};
struct Heartbeat {
  bool operator==(const Heartbeat&) const = default;
};
struct Goodbye {
  std::string reason;
  bool operator==(const Goodbye&) const = default;
};

// The place in the list is a message's number on the wire: new ones come at the end.
using ToWorker = std::variant<Welcome, Refused, SceneData, FrameStart, Assignment, Revoke, FrameEnd,
                              Heartbeat, Goodbye, AssetData, AssetEnd, Paired, Unneeded, PieceAssignment>;
using ToMaster = std::variant<Hello, Result, GiveBack, Heartbeat, Goodbye, Join, Holds, PieceResult>;

}  // namespace rayfarm
