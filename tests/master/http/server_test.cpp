#include "master/http/server.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <list>
#include <nlohmann/json.hpp>
#include <semaphore>
#include <thread>

#include "master/http/client.h"
#include "master/http/script_submission.h"
#include "master/http/submission.h"
#include "tests/support/raw_listener.h"
#include "tests/support/raw_peer.h"
#include "tests/support/test_server.h"
#include "tests/support/test_submission.h"

namespace rayfarm {
namespace {

using nlohmann::json;
using namespace std::chrono_literals;

class Server : public testing::Test {
 protected:
  HttpReply get(const std::string& target) { return send({"GET", server.url(), target, ""}); }
  HttpReply post(const std::string& target, const json& body) {
    return send({"POST", server.url(), target, body.dump()});
  }
  std::uint16_t port() const { return server.port(); }
  /// The whole answer to bytes sent by hand; "Connection: close" is up to the sender.
  std::string answer_to(const std::string& bytes) {
    RawPeer peer(port());
    peer.send(bytes);
    return peer.rest();
  }
  std::string status_line(const std::string& bytes) {
    const std::string answer = answer_to(bytes);
    return answer.substr(0, answer.find("\r\n"));
  }

  FarmThread farm;
  TestServer server{door_to(farm),
                    {.listen = "127.0.0.1:0", .header_patience = 300ms, .body_patience = 300ms}};
};

const std::string host = "Host: 127.0.0.1\r\n", close = "Connection: close\r\n";

TEST_F(Server, AnswersItsClient) {
  const HttpReply reply = get("/api/v1/version");
  EXPECT_EQ(reply.status, 200u);
  EXPECT_EQ(json::parse(reply.body)["api"], 1);
}

TEST_F(Server, TellsWhoWantsTheHeaderAloneThatOfTheWholeAnswer) {
  const std::string request = " /api/v1/version HTTP/1.1\r\n" + host;
  const std::string whole = answer_to("GET" + request + close + "\r\n");
  const std::string header = whole.substr(0, whole.find("\r\n\r\n") + 4);
  EXPECT_EQ(answer_to("HEAD" + request + close + "\r\n"), header);
  const std::string two = answer_to("HEAD" + request + "\r\nGET" + request + close + "\r\n");
  EXPECT_TRUE(two.ends_with(whole)) << two;
  EXPECT_EQ(two.find('{'), two.rfind('{')) << "the first one has no body";
}

TEST_F(Server, AJobGoesInAndItsFilmComesOut) {
  farm.add_renderer("pc1");
  const json job = json::parse(post("/api/v1/jobs", to_json(small_job())).body);
  std::uint64_t revision = job["revision"];
  const std::string target = "/api/v1/jobs/" + job["id"].dump();
  for (json now = job; now["state"] != "done"; revision = now["revision"])
    now = json::parse(get(target + "?wait=30&after=" + std::to_string(revision)).body);
  const std::string film = get(target + "/film").body;
  const Film decoded = decode_film({reinterpret_cast<const std::uint8_t*>(film.data()), film.size()});
  EXPECT_TRUE(decoded.is_complete());
}

TEST_F(Server, NewsWaitForAChangeAndNoLonger) {
  const std::uint64_t revision = json::parse(get("/api/v1/jobs").body)["revision"];
  std::jthread submitter([&] { post("/api/v1/jobs", to_json(small_job())); });
  const json news = json::parse(get("/api/v1/jobs?wait=30&after=" + std::to_string(revision)).body);
  EXPECT_EQ(news["jobs"].size(), 1u);
}

TEST_F(Server, KeepsAConnectionForTheNextRequest) {
  const std::string request = "GET /api/v1/version HTTP/1.1\r\n" + host;
  const std::string answer = answer_to(request + "\r\n" + request + close + "\r\n");
  EXPECT_NE(answer.find("HTTP/1.1 200", answer.find("HTTP/1.1 200") + 1), std::string::npos);
}

TEST_F(Server, ServesAPageThatMayLoadNothingFromElsewhere) {
  const std::string answer = answer_to("GET / HTTP/1.1\r\n" + host + close + "\r\n");
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 200")) << answer;
  EXPECT_NE(answer.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(answer.find("Cache-Control: no-cache"), std::string::npos);
}

// Asked for again and again until there is more to say, it would keep its asker for 30 s.
TEST_F(Server, LetsNobodyWaitWhoOnlyLooksWhileOrdersWaitForTheDisk) {
  std::counting_semaphore<> waiting{0}, disk{0};
  TestServer slow(door_to(farm), {.listen = "127.0.0.1:0"}, lone_master(), nullptr,
                  [&]() -> std::optional<std::string> {
                    waiting.release();
                    disk.acquire();
                    return std::nullopt;
                  });
  const auto order = [&] {
    EXPECT_EQ(send({"POST", slow.url(), "/api/v1/jobs/1/pause", "{}"}).status, 200u);
  };
  farm.run([](Farm& f, FarmTime now) { f.submit(small_job(), now); });
  {
    const std::jthread first(order), second(order);
    waiting.acquire(), waiting.acquire();  // at once
    EXPECT_EQ(send({"GET", slow.url(), "/api/v1/jobs", ""}).status, 200u);
    disk.release(2);
  }
}

TEST_F(Server, AJobThatIsNotThereIsNotWaitedFor) {
  std::uint64_t revision = 0;
  farm.run([&](Farm& f, FarmTime) { revision = f.revision(); });
  const std::string wait = "?wait=30&after=" + std::to_string(revision);
  HttpRequest request{"GET", server.url(), "/api/v1/jobs/7" + wait, "", 10s};
  EXPECT_EQ(send(request).status, 404u);
  request.target = "/api/v1/jobs/seven" + wait;
  EXPECT_EQ(send(request).status, 400u);
}

// Hostile peers.
// -----------------------------------------------------------------------------------------------

TEST_F(Server, RefusesAForeignHostOriginAndContentType) {
  EXPECT_EQ(status_line("GET /api/v1/jobs HTTP/1.1\r\nHost: evil.example\r\n\r\n"), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status_line("GET /api/v1/jobs HTTP/1.1\r\n\r\n"), "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status_line("GET /api/v1/jobs HTTP/1.1\r\n" + host + "Origin: http://evil.example\r\n\r\n"),
            "HTTP/1.1 403 Forbidden");
  EXPECT_EQ(status_line("POST /api/v1/jobs HTTP/1.1\r\n" + host +
                        "Content-Type: text/plain\r\nContent-Length: 2\r\n\r\n{}"),
            "HTTP/1.1 415 Unsupported Media Type");
  EXPECT_TRUE(json::parse(get("/api/v1/jobs").body)["jobs"].empty());
}

TEST_F(Server, RefusesAHugeHeader) {
  EXPECT_EQ(status_line("GET / HTTP/1.1\r\n" + host + "X: " + std::string(100'000, 'x') + "\r\n\r\n"),
            "HTTP/1.1 431 Request Header Fields Too Large");
  EXPECT_EQ(status_line("GET /" + std::string(100'000, 'x') + " HTTP/1.1\r\n" + host + "\r\n"),
            "HTTP/1.1 431 Request Header Fields Too Large");
}

TEST_F(Server, RefusesABodyThatIsAnnouncedTooLargeBeforeItComes) {
  const std::string type = "Content-Type: application/json\r\n";
  for (const std::string& request :
       {"POST /api/v1/jobs HTTP/1.1\r\n" + host + type + "Content-Length: 99999999999\r\n\r\n",
        "POST /api/v1/jobs/1/pause HTTP/1.1\r\n" + host + type + "Content-Length: 100000\r\n\r\n"})
    EXPECT_EQ(status_line(request), "HTTP/1.1 413 Payload Too Large");
}

// The answer must arrive although the peer is still talking: a connection closed at once would be reset.
TEST_F(Server, SaysThatABodyIsTooLargeAlsoWhenItComesAnyway) {
  const std::string body(1'000'000, ' ');
  EXPECT_EQ(status_line("POST /api/v1/jobs/1/pause HTTP/1.1\r\n" + host +
                        "Content-Type: application/json\r\nContent-Length: 1000000\r\n\r\n" + body),
            "HTTP/1.1 413 Payload Too Large");
}

TEST_F(Server, SaysHowLargeABodyMayBe) {
  EXPECT_NE(answer_to("POST /api/v1/jobs/1/pause HTTP/1.1\r\n" + host +
                      "Content-Type: application/json\r\nContent-Length: 100000\r\n\r\n")
                .find("the body is too large: at most 65536 bytes may come here"),
            std::string::npos);
}

std::string look_at(const std::string& script) {
  const std::string body = json{{"script", script}}.dump();
  return "POST /api/v1/scripts HTTP/1.1\r\n" + host +
         "Content-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) + "\r\n" + close +
         "\r\n" + body;
}
const std::string endless = look_at("while true do end");
const std::string tiny = look_at(
    "return scene{ camera = perspective{ from = {0, 0, -9}, angle = 60 }, lights = { ambient(1) }, root = "
    "sphere{} }");

// Three loops of one user once made another one's tiny script wait for a minute.
TEST_F(Server, AScriptIsLookedAtBesideThreeThatNeverEnd) {
  std::list<RawPeer> loops;
  for (int i = 0; i < 3; ++i) loops.emplace_back(port()).send(endless);
  EXPECT_TRUE(answer_to(tiny).starts_with("HTTP/1.1 200"));
  for (const RawPeer& loop : loops) {
    pollfd answered{loop.descriptor(), POLLIN, 0};
    EXPECT_EQ(::poll(&answered, 1, 0), 0);  // still at it
  }
}

// More than there are children: the answer comes once those who have left are dropped, long before their limits.
TEST_F(Server, AScriptOfWhoHasLeftIsNotEvaluated) {
  std::list<RawPeer> loops;
  for (int i = 0; i < 40; ++i) loops.emplace_back(port()).send(endless);
  loops.clear();
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_TRUE(answer_to(tiny).starts_with("HTTP/1.1 200"));
  EXPECT_LT(std::chrono::steady_clock::now() - begun,
            look_limits.wall);  // of the least of ten rounds of them
}

TEST_F(Server, AScriptThatIsLookedAtIsEndedSoonerThanOneToBeRendered) {
  const std::string answer = answer_to(endless);
  EXPECT_TRUE(answer.starts_with("HTTP/1.1 422")) << answer;
  EXPECT_NE(answer.find("takes more than 5"), std::string::npos) << answer;
}

// Room is for four of the largest; the others wait for their bodies, so only the refused one is answered.
TEST(HttpServer, LargeBodiesShareABoundedMemory) {
  FarmThread farm;
  const TestServer server(door_to(farm));
  std::list<RawPeer> peers;
  std::vector<pollfd> sockets;
  for (int i = 0; i < 5; ++i) {
    peers.emplace_back(server.port())
        .send("POST /api/v1/jobs HTTP/1.1\r\n" + host +
              "Content-Type: application/json\r\nContent-Length: 67108864\r\n\r\n");
    sockets.push_back({peers.back().descriptor(), POLLIN, 0});
  }
  ASSERT_EQ(::poll(sockets.data(), sockets.size(), -1), 1);
  auto socket = sockets.begin();
  for (RawPeer& peer : peers)
    if ((socket++)->revents != 0) {
      EXPECT_TRUE(peer.some().starts_with("HTTP/1.1 503"));
    }
}

// 200 MB of a script are not taken in before they are refused.
TEST_F(Server, RefusesAHugeScriptByItsAnnouncedLength) {
  EXPECT_EQ(status_line("POST /api/v1/scripts HTTP/1.1\r\n" + host +
                        "Content-Type: application/json\r\nContent-Length: 200000000\r\n\r\n"),
            "HTTP/1.1 413 Payload Too Large");
}

TEST_F(Server, RefusesABodyInChunksOnceItIsTooLarge) {
  std::string request = "POST /api/v1/jobs/1/pause HTTP/1.1\r\n" + host +
                        "Content-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 17; ++i) request += "1000\r\n" + std::string(4096, ' ') + "\r\n";
  EXPECT_EQ(status_line(request), "HTTP/1.1 413 Payload Too Large");
}

TEST_F(Server, AnswersGarbageWithAnErrorOrAnEnd) {
  EXPECT_EQ(status_line("hello\r\n\r\n"), "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(status_line(std::string(64, '\0')), "HTTP/1.1 400 Bad Request");
  EXPECT_EQ(status_line("\x16\x03\x01\x02\x00\x01\x00\x01\xfc"), "") << "TLS, and it has no certificate";
  EXPECT_EQ(get("/api/v1/version").status, 200u);
}

TEST_F(Server, ASilentOrSlowPeerIsLeft) {
  EXPECT_EQ(answer_to(""), "");
  EXPECT_EQ(answer_to("GET / HT"), "");
  EXPECT_EQ(answer_to("POST /api/v1/jobs/1/pause HTTP/1.1\r\n" + host +
                      "Content-Type: application/json\r\nContent-Length: 10\r\n\r\n{"),
            "");
}

// Each is served at once, however many do nothing: the one that has been idle longest makes room.
TEST(HttpServer, WhereThereIsNoRoomTheLongestIdleGoes) {
  FarmThread farm;
  const TestServer server(door_to(farm), {.listen = "127.0.0.1:0", .connections = 8});
  const std::string request = "GET /api/v1/version HTTP/1.1\r\n" + host + "\r\n";
  std::list<RawPeer> peers;
  for (int i = 0; i < 30; ++i) {
    peers.emplace_back(server.port()).send(request);
    EXPECT_TRUE(peers.back().some().starts_with("HTTP/1.1 200")) << i;
  }
  EXPECT_EQ(peers.front().rest(), "");
  peers.back().send(request);
  EXPECT_TRUE(peers.back().some().starts_with("HTTP/1.1 200"));
}

TEST(HttpServer, ServesOthersWhileManyAreSeenOff) {
  FarmThread farm;
  const TestServer server(door_to(farm), {.listen = "127.0.0.1:0", .connections = 4});
  std::list<RawPeer> refused;
  for (int i = 0; i < 40; ++i) {
    refused.emplace_back(server.port()).send("GET /api/v1/jobs HTTP/1.1\r\nHost: evil.example\r\n\r\n");
    EXPECT_TRUE(refused.back().some().starts_with("HTTP/1.1 403")) << i;  // and stays, as long as it may
  }
}

// What a film asks of the farm is kept here, so that two films keep the threads for long work busy.
TEST(HttpServer, CancelsAJobWhileFilmsTakeLong) {
  FarmThread farm;
  farm.run([](Farm& f, FarmTime now) { f.submit(small_job(), now); });
  std::counting_semaphore<2> kept(0);
  std::vector<FarmThread::Task> tasks;
  const TestServer server([&](FarmThread::Task task) {
    if (tasks.size() == 2) return farm.post(std::move(task));
    tasks.push_back(std::move(task));
    kept.release();
  });
  std::list<RawPeer> peers;
  for (int i = 0; i < 2; ++i) {
    peers.emplace_back(server.port()).send("GET /api/v1/jobs/1/film HTTP/1.1\r\n" + host + "\r\n");
    kept.acquire();
  }
  EXPECT_EQ(send({"POST", server.url(), "/api/v1/jobs/1/cancel", "{}"}).status, 200u);
}

// The server and its client.
// -----------------------------------------------------------------------------------

TEST(HttpServer, EndsWhileAPeerWaitsForNewsAndTheFarmIsBusy) {
  FarmThread farm;
  std::promise<void> busy, free;
  auto server = std::make_unique<TestServer>(door_to(farm));
  farm.post([&](Farm&, FarmTime) { busy.set_value(), free.get_future().wait(); });
  busy.get_future().wait();
  const std::string url = server->url();
  std::jthread waiting([&] { EXPECT_ANY_THROW(send({"GET", url, "/api/v1/jobs?wait=30", ""})); });
  RawPeer another(server->port());
  another.send("GET /api/v1/jobs HTTP/1.1\r\nHost: localhost\r\n\r\n");
  server.reset();
  free.set_value();
}

TEST(HttpServer, ListensOnLoopbackOnlyUnlessToldOtherwise) {
  FarmThread farm;
  EXPECT_THROW(TestServer(door_to(farm), {.listen = "0.0.0.0:0"}), HttpError);
  EXPECT_THROW(TestServer(door_to(farm), {.listen = "[::]:0"}), HttpError);
  EXPECT_NO_THROW(TestServer(door_to(farm), {.listen = "0.0.0.0:0", .exposure = Exposure::insecure}));
}

TEST(HttpServer, SaysWhyItCannotListen) {
  FarmThread farm;
  for (const char* listen :
       {"", "5412", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:70000", "no-name:1"})
    EXPECT_THROW(TestServer(door_to(farm), {.listen = listen}), HttpError) << listen;
  const TestServer first(door_to(farm));
  EXPECT_THROW(TestServer(door_to(farm), {.listen = first.url().substr(7)}), HttpError);
}

TEST(HttpClient, SaysThatNobodyAnswers) {
  std::string url;
  {
    FarmThread farm;
    url = TestServer(door_to(farm)).url();
  }
  EXPECT_THROW(send({"GET", url, "/", ""}), MasterUnreachable);
  EXPECT_THROW(send({"GET", "http://no-such-host.invalid:1", "/", ""}), MasterUnreachable);
  for (const char* wrong : {"", "127.0.0.1:5412", "ftp://127.0.0.1", "http://", "http://a:b", "http://a/b"})
    EXPECT_THROW(send({"GET", wrong, "/", ""}), std::invalid_argument) << wrong;
}

TEST(HttpClient, LeavesASilentMaster) {
  RawListener silent;
  EXPECT_THROW(send({"GET", silent.url(), "/", "", 0s}), RequestTimedOut);
}

// One byte each time that it asks: longer than its patience, but never silent.
TEST(HttpClient, StaysWhileBytesCome) {
  RawListener slow;
  const std::string body(30, 'x'), answer = "HTTP/1.1 200 OK\r\nContent-Length: 30\r\n\r\n" + body;
  std::size_t sent = answer.size() - body.size();
  HttpRequest request{"GET", slow.url(), "/", "", 1s};
  request.cancelled = [&] {
    if (!slow.accepted())
      if (slow.accept()) slow.send(answer.substr(0, sent));
    if (slow.accepted() && sent < answer.size()) slow.send(answer.substr(sent++, 1));
    return false;
  };
  EXPECT_EQ(send(request).body, body);
}

TEST(HttpClient, LeavesWhenToldTo) {
  FarmThread farm;
  const TestServer server(door_to(farm));
  HttpRequest request{"GET", server.url(), "/api/v1/jobs?wait=30&after=0", ""};
  farm.run([&](Farm& f, FarmTime) {
    request.target = "/api/v1/jobs?wait=30&after=" + std::to_string(f.revision());
  });
  request.cancelled = [] { return true; };
  EXPECT_THROW(send(request), RequestCancelled);
}

}  // namespace
}  // namespace rayfarm
