// What becomes of those who are connected: when their token is revoked, and when others want their place.
#include <poll.h>

#include <list>
#include <vector>

#include "tests/master/http/people_fixture.h"

namespace rayfarm {
namespace {

TEST_F(People, WhoWaitForNewsGetNoneWhenTheirTokenIsRevokedMeanwhile) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued viewer = access.issue({.kind = CredentialKind::token, .role = Role::viewer}, now);
  std::uint64_t revision = 0;
  farm.run([&](Farm& f, FarmTime) { revision = f.revision(); });
  RawPeer peer(server.port());
  peer.send("GET /api/v1/jobs?wait=1&after=" + std::to_string(revision) +
            " HTTP/1.1\r\nHost: 127.0.0.1\r\nVia: 1.1 proxy\r\nAuthorization: Bearer " +
            text_of(viewer.token) + "\r\nConnection: close\r\n\r\n");
  access.revoke(viewer.credential.id);
  EXPECT_TRUE(peer.rest().starts_with("HTTP/1.1 401"));
}

TEST_F(People, WhoseTokenIsRevokedWhileTheyAreStillSendingChangeNothing) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued admin = access.issue({.kind = CredentialKind::token, .role = Role::admin}, now);
  const std::size_t before = access.list().size();
  RawPeer peer(server.port());
  peer.send(
      "POST /api/v1/tokens HTTP/1.1\r\nHost: 127.0.0.1\r\nVia: 1.1 proxy\r\nExpect: 100-continue\r\n"
      "Content-Type: application/json\r\nContent-Length: 2\r\nAuthorization: Bearer " +
      text_of(admin.token) + "\r\nConnection: close\r\n\r\n{");
  access.revoke(admin.credential.id);
  peer.send("}");
  EXPECT_TRUE(peer.rest().starts_with("HTTP/1.1 401"));
  EXPECT_EQ(access.list().size(), before);
}

TEST_F(People, WhoAreNobodyMakeRoomWhileTheirLoginIsStillComing) {
  HttpSettings few = settings(Exposure::loopback_only);
  few.connections = 2;
  const TestServer server(door_to(farm), few, master(), &access);
  RawPeer first(server.port()), second(server.port());
  for (RawPeer* slow : {&first, &second})
    slow->send(
        "POST /api/v1/login HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        "Content-Length: 100\r\n\r\n{");
  for (int i = 0; i < 3; ++i) EXPECT_EQ(status_of(server.url(), "GET", "/api/v1/tokens", ""), 200u);
  EXPECT_EQ(first.rest(), "") << "the longest there has gone";
}

std::string live_request(const std::string& shown) {
  return "GET /api/v1/live HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Forwarded-For: 10.0.0.7\r\nUpgrade: "
         "websocket\r\n"
         "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\nSec-WebSocket-Key: "
         "dGhlIHNhbXBsZSBub25jZQ==\r\n"
         "Authorization: Bearer " +
         shown + "\r\n\r\n";
}

TEST_F(People, WhoHoldAllConnectionsLeaveRoomForOthers) {
  HttpSettings few = settings(Exposure::loopback_only);
  few.connections = 8;
  const TestServer server(door_to(farm), few, master(), &access);
  const std::string viewer = token(Role::viewer), artist = token(Role::artist);
  RawPeer other(server.port());
  other.send(live_request(artist));
  EXPECT_TRUE(other.some().starts_with("HTTP/1.1 101"));
  std::list<RawPeer> greedy;
  for (int i = 0; i < 20; ++i) {
    greedy.emplace_back(server.port()).send(live_request(viewer));
    EXPECT_TRUE(greedy.back().some().starts_with("HTTP/1.1 101")) << i;
  }
  EXPECT_EQ(status_of(server.url(), "GET", "/api/v1/tokens", ""), 200u) << "the admin comes in";
  greedy.front().rest();  // has gone
  pollfd looked_at{other.descriptor(), POLLRDHUP, 0};
  EXPECT_EQ(::poll(&looked_at, 1, 0), 0) << "who holds one connection keeps it";
}

TEST_F(People, WhoseTokenIsRevokedWhileTheirRequestWaitsForItsTurnChangeNothing) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued artist = access.issue({.kind = CredentialKind::token, .role = Role::artist}, now);
  const std::string body =
      R"({"script": "local i = 0 while i < 3e6 do i = i + 1 end return scene{ root = sphere{} }"})";
  const std::string request =
      "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nVia: 1.1 proxy\r\nContent-Type: application/json\r\n"
      "Content-Length: " +
      std::to_string(body.size()) + "\r\nAuthorization: Bearer " + text_of(artist.token) +
      "\r\nConnection: close\r\n\r\n" + body;
  std::list<RawPeer> waiting;
  for (int i = 0; i < 40; ++i) waiting.emplace_back(server.port()).send(request);
  std::vector<pollfd> answers;
  for (const RawPeer& peer : waiting) answers.push_back({peer.descriptor(), POLLIN, 0});
  ASSERT_GT(::poll(answers.data(), answers.size(), -1), 0);
  access.revoke(artist.credential.id);
  std::size_t taken = 0;
  for (RawPeer& peer : waiting) {
    const std::string answer = peer.rest();
    taken += is_status(answer, 201);
    EXPECT_TRUE(is_status(answer, 201) || is_status(answer, 401)) << answer;
  }
  EXPECT_LT(taken, waiting.size()) << "some were behind the first";
  std::size_t jobs = 0;
  farm.run([&](Farm& f, FarmTime now) { jobs = f.jobs(now).size(); });
  EXPECT_EQ(jobs, taken);
}

TEST_F(People, WhoWatchAreCutOffAtOnceWhenTheirTokenIsRevoked) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued viewer = access.issue({.kind = CredentialKind::token, .role = Role::viewer}, now);
  RawPeer nobody(server.port());
  nobody.send(live_request("hello"));
  EXPECT_TRUE(nobody.rest().starts_with("HTTP/1.1 401"));
  RawPeer peer(server.port());
  peer.send(live_request(text_of(viewer.token)));
  EXPECT_TRUE(peer.some().starts_with("HTTP/1.1 101"));
  access.revoke(viewer.credential.id);
  peer.rest();  // comes to an end
}

TEST_F(People, WhoWatchAreCutOffWhenTheirTokenExpires) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued viewer =
      access.issue({.kind = CredentialKind::token, .role = Role::viewer, .lifetime = std::chrono::seconds(2)},
                   std::chrono::system_clock::now());
  RawPeer peer(server.port());
  peer.send(live_request(text_of(viewer.token)));
  EXPECT_TRUE(peer.some().starts_with("HTTP/1.1 101"));
  peer.rest();  // comes to an end
  EXPECT_GE(std::chrono::system_clock::now() + std::chrono::seconds(1), viewer.credential.until)
      << "whole seconds";
}

}  // namespace
}  // namespace rayfarm
