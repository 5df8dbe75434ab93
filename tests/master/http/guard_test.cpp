#include "master/http/guard.h"

#include <gtest/gtest.h>

namespace rayfarm {
namespace {

const ListenAddress loopback{"127.0.0.1", true, "pc7"};
const ListenAddress everywhere{"0.0.0.0", false, "pc7"};

ApiRequest get(const std::string& host) { return {"GET", "/", host, "", "", "", ""}; }

unsigned status_of(const ApiRequest& request, const ListenAddress& listening = loopback) {
  const auto refused = refusal(request, listening);
  return refused ? refused->status : 200;
}

TEST(Guard, TheHostMustBeThisPc) {
  for (const char* host :
       {"127.0.0.1:5412", "127.0.0.1", "localhost:5412", "LOCALHOST", "[::1]:5412", "localhost:8080"})
    EXPECT_EQ(status_of(get(host)), 200u) << host;
  for (const char* host : {"", "evil.example", "evil.example:5412", "127.0.0.1.evil.example",
                           "localhost.evil.example", "192.168.1.7:5412", "pc7", "[", "[]", ":5412"})
    EXPECT_EQ(status_of(get(host)), 403u) << host;
}

// DNS rebinding needs a name; an address in Host is the one that was really connected to.
TEST(Guard, BeyondLoopbackAnyAddressAndThePcsOwnNameWillDo) {
  for (const char* host : {"192.168.1.7:5412", "[fe80::1]:5412", "pc7:5412", "PC7.local", "localhost"})
    EXPECT_EQ(status_of(get(host), everywhere), 200u) << host;
  for (const char* host : {"evil.example:5412", "pc7.evil.example", ""})
    EXPECT_EQ(status_of(get(host), everywhere), 403u) << host;
}

TEST(Guard, WhoComesOverLoopbackUnderALoopbackNameIsFromThisPc) {
  const auto is_near = [](const std::string& from, const std::string& host) {
    ApiRequest request = get(host);
    request.from = from;
    return is_from_this_pc(request);
  };
  EXPECT_TRUE(is_near("127.0.0.1", "localhost:5412"));
  EXPECT_TRUE(is_near("127.0.0.2", "127.0.0.2:5412"));
  EXPECT_TRUE(is_near("::1", "[::1]:5412"));
  for (const char* host : {"evil.example", "127.0.0.1.evil.example", "192.168.1.7", "127.1"})
    EXPECT_FALSE(is_near("127.0.0.1", host)) << host;
  EXPECT_FALSE(is_near("10.0.0.7", "127.0.0.1"));
}

TEST(Guard, AnOriginMustBeTheMasterItself) {
  ApiRequest request = get("127.0.0.1:5412");
  request.origin = "http://127.0.0.1:5412";
  EXPECT_EQ(status_of(request), 200u);
  for (const char* origin : {"http://evil.example", "http://127.0.0.1:8000", "https://127.0.0.1:5412", "null",
                             "http://localhost:5412", "file://"}) {
    request.origin = origin;
    EXPECT_EQ(status_of(request), 403u) << origin;
  }
}

TEST(Guard, PicturesAreNotForPagesFromElsewhereButTheyMayLinkToThePage) {
  ApiRequest request = get("localhost:5412");
  request.fetch_site = "cross-site";
  EXPECT_EQ(status_of(request), 200u);
  request.target = "/api/v1/jobs/1/picture.png";
  request.fetch_site = "cross-site";
  EXPECT_EQ(status_of(request), 403u);
  request.fetch_site = "same-site";
  EXPECT_EQ(status_of(request), 403u);
  request.fetch_site = "same-origin";
  EXPECT_EQ(status_of(request), 200u);
}

TEST(Guard, PostsMustBeJsonWhichPagesMaySendOnlyWhenAllowedTo) {
  ApiRequest request{"POST", "/api/v1/jobs", "localhost:5412", "", "", "", "{}"};
  for (const char* type :
       {"", "text/plain", "application/x-www-form-urlencoded", "text/plain;application/json"}) {
    request.content_type = type;
    EXPECT_EQ(status_of(request), 415u) << type;
  }
  for (const char* type : {"application/json", "application/json; charset=utf-8", "Application/JSON ;x=y"}) {
    request.content_type = type;
    EXPECT_EQ(status_of(request), 200u) << type;
  }
}

}  // namespace
}  // namespace rayfarm
