// How browsers become somebody, and nobody again.
#include <nlohmann/json.hpp>

#include "master/http/people.h"
#include "tests/master/http/people_fixture.h"

namespace rayfarm {
namespace {

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

}  // namespace
}  // namespace rayfarm
