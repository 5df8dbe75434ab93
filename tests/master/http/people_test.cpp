// Who may ask what: the whole server, over plaintext and TLS on loopback.
#include "master/http/people.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <list>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <thread>

#include "master/http/api.h"
#include "master/http/client.h"
#include "tests/support/raw_listener.h"
#include "tests/support/raw_peer.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/test_server.h"

namespace rayfarm {
namespace {

const WallTime now = std::chrono::system_clock::now();

struct People : testing::Test {
  ScratchFolder folder;
  Access access{folder.path(), {"localhost", "127.0.0.1"}, now};
  FarmThread farm;
  std::mutex mutex;
  std::vector<std::string> told, noted;  // refusals; what was done

  /// A line with these words is among them.
  bool has_line(const std::vector<std::string>& lines, std::string_view words) {
    const std::lock_guard lock(mutex);
    return std::ranges::any_of(lines, [&](const auto& line) { return line.find(words) != line.npos; });
  }

  Identity identity() const {
    return {access.identity().key, access.identity().certificate + access.authority()};
  }
  HttpSettings settings(Exposure exposure) const {
    return {.listen = "127.0.0.1:0", .exposure = exposure, .identity = identity()};
  }
  MasterDoor master() {
    MasterDoor door = lone_master();
    door.tell = [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      told.push_back(line);
    };
    door.note = [this](const std::string& line) {
      const std::lock_guard lock(mutex);
      noted.push_back(line);
    };
    return door;
  }
  std::string token(Role role) {
    return text_of(access.issue({.kind = CredentialKind::token, .role = role}, now).token);
  }
};

unsigned status_of(const std::string& url, const std::string& method, const std::string& target,
                   const std::string& token) {
  return send({.method = method, .url = url, .target = target, .body = "{}", .token = token}).status;
}

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

/// A browser on another PC, behind a proxy.
class Browser {
 public:
  explicit Browser(const TestServer& server) : port_(server.port()) {}

  std::string get(const std::string& target) { return visit("GET " + target + " HTTP/1.1\r\n" + fields()); }
  /// It keeps the cookie that it is given.
  std::string post(const std::string& target, const std::string& body) {
    const std::string answer =
        visit("POST " + target + " HTTP/1.1\r\nContent-Type: application/json\r\nContent-Length: " +
              std::to_string(body.size()) + "\r\n" + fields() + body);
    constexpr std::string_view field = "Set-Cookie: ";
    if (const std::size_t at = answer.find(field); at != std::string::npos) {
      set_cookie = answer.substr(at + field.size(), answer.find('\r', at) - at - field.size());
      cookie = set_cookie.substr(0, set_cookie.find(';'));
    }
    return answer;
  }
  /// Its live connection, which is open.
  void watch(RawPeer& peer) {
    peer.send(
        "GET /api/v1/live HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nHost: 127.0.0.1\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        "X-Forwarded-For: 10.0.0.7\r\nCookie: " +
        cookie + "\r\n\r\n");
    EXPECT_TRUE(peer.some().starts_with("HTTP/1.1 101"));
  }
  std::string session() const { return cookie.substr(cookie.find('=') + 1); }

  std::string cookie, set_cookie;

 private:
  std::string fields() const {
    return "Host: 127.0.0.1\r\nX-Forwarded-For: 10.0.0.7\r\nCookie: a=b; " + cookie +
           "\r\nConnection: close\r\n\r\n";
  }
  std::string visit(const std::string& request) const {
    RawPeer peer(port_);
    peer.send(request);
    return peer.rest();
  }
  const std::uint16_t port_;
};

bool is_status(const std::string& answer, int status) {
  return answer.starts_with("HTTP/1.1 " + std::to_string(status));
}

TEST_F(People, ComeInWithALoginLinkOnceWhateverLookedAtItBefore) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const auto made = nlohmann::json::parse(send({.method = "POST",
                                                .url = server.url(),
                                                .target = "/api/v1/tokens",
                                                .body = R"({"role": "viewer", "name": "Ann", "link": true})"})
                                              .body);
  const std::string link = made.at("link"), code = made.at("token");
  ASSERT_TRUE(link.ends_with("/#/login/" + code)) << "a browser keeps what follows # to itself: " << link;

  Browser browser(server);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(is_status(browser.get("/"), 200)) << "as a chat program does";
  EXPECT_EQ(browser.cookie, "");
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 401));
  const std::string answer = browser.post("/api/v1/login", R"({"code": ")" + code + R"("})");
  EXPECT_TRUE(is_status(answer, 200)) << answer;
  EXPECT_NE(answer.find(R"("name":"Ann")"), std::string::npos) << answer;
  EXPECT_TRUE(browser.set_cookie.ends_with("; Path=/; HttpOnly; SameSite=Strict; Max-Age=604800"))
      << browser.set_cookie;
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 200));
  EXPECT_NE(browser.get("/api/v1/login").find(R"("role":"viewer")"), std::string::npos);
  EXPECT_TRUE(is_status(Browser(server).post("/api/v1/login", R"({"code": ")" + code + R"("})"), 403))
      << "the second time";
  access.revoke(made.at("id"));
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 401));
  EXPECT_NE(browser.get("/api/v1/login").find(R"("session":null)"), std::string::npos);
}

TEST_F(People, ComeInWithATokenForWhichTheirBrowserGetsASessionOfItsOwn) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const Issued artist = access.issue({.kind = CredentialKind::token, .role = Role::artist}, now);
  Browser browser(server);
  const auto log_in = [&](const std::string& body) { return browser.post("/api/v1/login", body); };
  const std::string answer = log_in(R"({"token": " )" + text_of(artist.token) + R"( "})");
  EXPECT_TRUE(is_status(answer, 200)) << answer;
  EXPECT_EQ(access.check_person(browser.session(), "", now).parent, artist.credential.id);
  for (const char* bad :
       {R"({"token": "hello"})", R"({"token": "a; Domain=example.com"})", R"({"code": "hello"})"})
    EXPECT_TRUE(is_status(log_in(bad), 403)) << bad;
  EXPECT_TRUE(is_status(log_in(R"({"code": ")" + text_of(artist.token) + R"("})"), 403)) << "it is no link";
  for (const char* bad : {R"({"token": 7})", R"({})", R"({"token": "a", "code": "b"})"})
    EXPECT_TRUE(is_status(log_in(bad), 422)) << bad;
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 200));
  access.revoke(artist.credential.id);
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 401));
}

TEST_F(People, WhoLogOutAreNobodyAtOnceOnAllTheirConnections) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  const std::string artist = token(Role::artist);
  Browser browser(server), other(server);
  for (Browser* one : {&browser, &other}) one->post("/api/v1/login", R"({"token": ")" + artist + R"("})");
  const std::string session = browser.session();
  RawPeer watching(server.port());
  browser.watch(watching);
  const std::string kept = browser.cookie;
  EXPECT_TRUE(is_status(browser.post("/api/v1/logout", "{}"), 200));
  EXPECT_EQ(browser.set_cookie, "rayfarm=; Path=/; HttpOnly; SameSite=Strict; Max-Age=0");
  watching.rest();  // comes to an end
  browser.cookie = kept;
  EXPECT_TRUE(is_status(browser.get("/api/v1/jobs"), 401)) << "also for who has kept it";
  EXPECT_THROW(access.check_person(session, "", now), AccessRefused);
  EXPECT_TRUE(is_status(browser.post("/api/v1/logout", "{}"), 200)) << "it is ended already";
  EXPECT_TRUE(is_status(other.get("/api/v1/jobs"), 200)) << "another browser stays";
  EXPECT_EQ(access.check_person(artist, "", now).role, Role::artist) << "and the token good";
}

TEST_F(People, CannotBeLoggedOutOrInByPagesFromElsewhere) {
  const TestServer server(door_to(farm), settings(Exposure::loopback_only), master(), &access);
  for (const char* target : {"/api/v1/login", "/api/v1/logout"}) {
    RawPeer peer(server.port());
    peer.send("POST " + std::string(target) +
              " HTTP/1.1\r\nHost: 127.0.0.1\r\nOrigin: http://elsewhere.example\r\nContent-Type: "
              "application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{}");
    EXPECT_TRUE(is_status(peer.rest(), 403)) << target;
  }
  EXPECT_TRUE(has_line(told, "nobody at 127.0.0.1: a page from elsewhere"));
}

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
      R"({"script": "local i = 0 while i < 3e7 do i = i + 1 end return scene{ root = sphere{} }"})";
  const std::string request =
      "POST /api/v1/jobs HTTP/1.1\r\nHost: 127.0.0.1\r\nVia: 1.1 proxy\r\nContent-Type: application/json\r\n"
      "Content-Length: " +
      std::to_string(body.size()) + "\r\nAuthorization: Bearer " + text_of(artist.token) +
      "\r\nConnection: close\r\n\r\n" + body;
  std::list<RawPeer> waiting;
  for (int i = 0; i < 40; ++i) waiting.emplace_back(server.port()).send(request);
  EXPECT_TRUE(waiting.front().rest().starts_with("HTTP/1.1 201"));
  access.revoke(artist.credential.id);
  EXPECT_TRUE(waiting.back().rest().starts_with("HTTP/1.1 401")) << "it was behind the others";
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

TEST_F(People, DoNotTalkToAMasterThatTheirTokenIsNotFor) {
  const TestServer server(door_to(farm), settings(Exposure::closed), master(), &access);
  const std::string elsewhere = text_of(new_token(std::string(64, 'a')));
  EXPECT_THROW(status_of(server.url(), "GET", "/api/v1/jobs", elsewhere), MasterUntrusted);
  EXPECT_THROW(status_of(server.url(), "GET", "/api/v1/jobs", ""), MasterUntrusted);
  EXPECT_THROW(status_of("http://192.0.2.1:5412", "GET", "/api/v1/jobs", token(Role::viewer)),
               std::invalid_argument)
      << "a token does not leave this PC in plaintext";
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
  for (const char* bad : {R"({"role": "king"})", R"({"uses": 0})", R"({"ttl": -1})", R"({"name": "\u0007"})",
                          R"({"role": "worker", "link": true})"})
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
