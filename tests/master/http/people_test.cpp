// Who may ask what: the whole server, over plaintext and TLS on loopback.
#include "master/http/people.h"

#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "common/net/certificates.h"
#include "master/http/api.h"
#include "tests/master/http/people_fixture.h"
#include "tests/support/raw_listener.h"

namespace rayfarm {
namespace {

TEST(Roles, AreNeededOnEachRouteButThoseThatTellNothingOfTheFarm) {
  std::set<std::string> open;
  for (const ApiRoute& route : api_routes()) {
    ApiRequest request;
    request.method = route.method, request.target = route.path;
    const std::optional<Role> needed = role_needed(request);
    if (!needed)
      open.insert(route.method + " " + route.path);
    else
      EXPECT_GE(*needed, route.method == "GET" ? Role::viewer : Role::artist) << route.path;
  }
  EXPECT_EQ(open, (std::set<std::string>{"GET /api/v1/version", "GET /api/v1/openapi.json",
                                         "GET /api/v1/authority.pem", "GET /api/v1/login",
                                         "POST /api/v1/login", "POST /api/v1/logout"}));
}

TEST_F(People, OfAClosedMasterAreWhatTheirTokensSay) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  const std::string viewer = token(Role::viewer), artist = token(Role::artist), admin = token(Role::admin);
  const auto status = [&](const char* method, const char* target, const std::string& shown) {
    return status_of(server.url(), method, target, shown);
  };
  ASSERT_TRUE(server.url().starts_with("https://")) << server.url();
  EXPECT_EQ(status("GET", "/api/v1/jobs", viewer), 200u);
  EXPECT_EQ(status("POST", "/api/v1/jobs/1/pause", viewer), 403u);
  EXPECT_EQ(status("POST", "/api/v1/jobs/1/pause", artist), 404u) << "it may, but there is no such job";
  EXPECT_EQ(status("POST", "/api/v1/workers/pc/drain", artist), 403u);
  EXPECT_TRUE(has_line(told, "who is artist at 127.0.0.1 may not POST /api/v1/workers/pc/drain"));
  EXPECT_EQ(status("POST", "/api/v1/workers/pc/drain", admin), 404u);
  EXPECT_EQ(status("GET", "/api/v1/tokens", artist), 403u);
  EXPECT_EQ(status("GET", "/api/v1/tokens", admin), 200u);
  EXPECT_EQ(status("GET", "/", text_of(new_token(access.fingerprint()))), 200u)
      << "the app's files hold nothing";
  EXPECT_EQ(status("GET", "/api/v1/authority.pem", viewer), 200u);
}

TEST_F(People, WithoutAGoodTokenAreNobodyAndOnlyTheLogSaysWhy) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  const Issued revoked = access.issue({.kind = CredentialKind::token, .role = Role::admin}, now);
  access.revoke(revoked.credential.id);
  const HttpReply reply =
      send({.url = server.url(), .target = "/api/v1/jobs", .body = {}, .token = text_of(revoked.token)});
  EXPECT_EQ(reply.status, 401u);
  EXPECT_EQ(reply.body.find("revoked"), std::string::npos);
  const std::lock_guard lock(mutex);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0].find("nobody at 127.0.0.1: token " + revoked.credential.id + " was revoked"),
            std::string::npos)
      << told[0];
}

TEST_F(People, WithAnExpiredTokenAreNobodyAndTheLogSaysWhich) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  const Issued expired = access.issue({.kind = CredentialKind::token, .role = Role::admin},
                                      now - std::chrono::hours(3));  // it was for one
  const HttpReply reply =
      send({.url = server.url(), .target = "/api/v1/jobs", .body = {}, .token = text_of(expired.token)});
  EXPECT_EQ(reply.status, 401u);
  EXPECT_EQ(reply.body.find("expired"), std::string::npos);
  EXPECT_TRUE(has_line(told, "nobody at 127.0.0.1: token " + expired.credential.id + " has expired"));
}

TEST_F(People, OfThisPcNeedNoTokenUnlessItIsClosed) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  ASSERT_TRUE(server.url().starts_with("http://")) << server.url();
  EXPECT_EQ(status_of(server.url(), "GET", "/api/v1/tokens", ""), 200u);
  const std::string https = "https" + server.url().substr(4);
  EXPECT_EQ(status_of(https, "GET", "/api/v1/tokens", token(Role::admin)), 200u) << "TLS at the same port";
}

TEST_F(People, OfThisPcAreKnownAlsoWhereAllAddressesAreListenedTo) {
  HttpSettings everywhere = settings(Exposure::loopback_only);
  for (const char* any : {"0.0.0.0:0", "[::]:0"}) try {
      everywhere.listen = any;
      const TestServer server(door_to(farm), everywhere, master(), &access);
      EXPECT_TRUE(server.url().starts_with("https://")) << server.url();
      const std::string url = "http://127.0.0.1:" + std::to_string(server.port());
      EXPECT_EQ(status_of(url, "GET", "/api/v1/tokens", ""), 200u) << any;
    } catch (const HttpError& error) {
      GTEST_SKIP() << "this PC has no IPv6: " << error.what();
    }
}

TEST_F(People, WhomAProxyForwardsAreNotOfThisPc) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  RawPeer peer(server.port());
  peer.send(
      "GET /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Forwarded-For: 10.0.0.7\r\nConnection: "
      "close\r\n\r\n");
  EXPECT_TRUE(peer.rest().starts_with("HTTP/1.1 401"));
}

TEST_F(People, SpeakNoPlaintextWithAClosedMaster) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  RawPeer peer(server.port());
  peer.send("GET / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n");
  EXPECT_EQ(peer.rest(), "");
  EXPECT_TRUE(has_line(told, "nobody at 127.0.0.1: it asks without encryption"));
  try {
    status_of("http" + server.url().substr(5), "GET", "/api/v1/jobs", "");
    ADD_FAILURE();
  } catch (const MasterUnreachable& error) {
    EXPECT_NE(std::string(error.what()).find("wants https://"), std::string::npos) << error.what();
  }
}

TEST_F(People, ShowNoTokenToWhoListensInTheMastersPlace) {
  RawListener thief;
  const std::string shown = token(Role::admin);
  std::string seen;
  std::jthread stealing([&] {
    while (!thief.accept()) std::this_thread::yield();
    seen = thief.some();
    thief.send("HTTP/1.1 200 OK\r\nContent-Length: 0\r\n\r\n");
  });
  EXPECT_THROW(status_of(thief.url(), "GET", "/api/v1/jobs", shown), MasterUnreachable);
  stealing.join();
  EXPECT_FALSE(seen.empty());
  EXPECT_EQ(seen.find(shown), std::string::npos);
}

TEST_F(People, DoNotTalkToAMasterThatTheirTokenIsNotFor) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  const std::string elsewhere = text_of(new_token(std::string(64, 'a')));
  EXPECT_THROW(status_of(server.url(), "GET", "/api/v1/jobs", elsewhere), MasterUntrusted);
  EXPECT_THROW(status_of(server.url(), "GET", "/api/v1/jobs", ""), MasterUntrusted);
  EXPECT_THROW(status_of("http://192.0.2.1:5412", "GET", "/api/v1/jobs", token(Role::viewer)),
               std::invalid_argument)
      << "a token does not leave this PC in plaintext";
}

TEST_F(People, WithATokenAreToldWhereItIsOfNoUse) {
  const auto complaint_of = [&](const HttpSettings& settings) -> std::string {
    const TestServer server(door_to(farm), settings, master(), &access);
    try {
      status_of("http" + server.url().substr(server.url().find(':')), "GET", "/api/v1/jobs",
                token(Role::viewer));
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  HttpSettings plain = settings(Exposure::loopback_only), own = plain;
  plain.identity = std::nullopt;
  EXPECT_NE(complaint_of(plain).find("without RAYFARM_TOKEN_FILE also in plaintext"), std::string::npos);
  const Identity elsewhere = new_authority(now);
  own.identity = Identity{elsewhere.key, elsewhere.certificate};
  EXPECT_NE(complaint_of(own).find("a certificate of its own"), std::string::npos);
  EXPECT_EQ(complaint_of(settings(Exposure::loopback_only)), "");
}

TEST_F(People, MakeAndRevokeTokensOverTheApi) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const auto post = [&](const std::string& target, const std::string& body) {
    return send({.method = "POST", .url = server.url(), .target = target, .body = body});
  };
  const auto made =
      nlohmann::json::parse(post("/api/v1/tokens", R"({"role": "artist", "name": "Ann"})").body);
  EXPECT_EQ(access.check_person(made.at("token"), "", now).role, Role::artist);
  EXPECT_EQ(made.at("authority"), access.fingerprint());
  const std::string id = made.at("id");
  EXPECT_TRUE(has_line(noted, "token " + id + " (\"Ann\", artist) was made at 127.0.0.1"));
  EXPECT_EQ(post("/api/v1/tokens/" + id + "/revoke", "{}").status, 200u);
  EXPECT_TRUE(has_line(noted, "token " + id + " (\"Ann\", artist) was revoked at 127.0.0.1"));
  EXPECT_FALSE(has_line(noted, made.at("token").get<std::string>()));
  EXPECT_THROW(access.check_person(made.at("token"), "", now), AccessRefused);
  for (const char* bad :
       {R"({"role": "king"})", R"({"uses": 0})", R"({"ttl": -1})", R"({"name": "\u0007"})",
        R"({"role": "worker", "link": true})", R"({"role": "viewer", "link": "yes"})",
        R"({"role": "viewer", "link": true, "uses": 2})", R"({"role": "viewer", "uses": 2})"})
    EXPECT_EQ(post("/api/v1/tokens", bad).status, 422u) << bad;
  EXPECT_EQ(post("/api/v1/tokens", R"({"rolle": "king"})").status, 400u);
  EXPECT_EQ(post("/api/v1/tokens/nobody/revoke", "{}").status, 404u);
}

TEST_F(People, OfAnotherVersionAreToldSo) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const HttpReply reply = send({.url = server.url(), .target = "/api/v2/jobs", .body = {}});
  EXPECT_EQ(reply.status, 426u);
  EXPECT_NE(reply.body.find("install the same rayfarm on both PCs"), std::string::npos);
}

}  // namespace
}  // namespace rayfarm
