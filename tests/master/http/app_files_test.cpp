#include "master/http/app_files.h"

#include <gtest/gtest.h>

#include "tests/support/scratch_folder.h"

namespace rayfarm {
namespace {

TEST(AppFiles, AreServedWithTheirTypesAndHashedNamesForEver) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "assets");
  put_content(folder / "index.html", "<p>app</p>");
  put_content(folder / "assets/app-1a.js", "app()");
  const AppFiles app(folder.path());

  const ApiResponse index = app.answer("/"), script = app.answer("/assets/app-1a.js");
  EXPECT_EQ(index.body.text(), "<p>app</p>");
  EXPECT_EQ(index.content_type, "text/html; charset=utf-8");
  EXPECT_EQ(index.caching, Caching::ask_again);
  EXPECT_EQ(script.body.text(), "app()");
  EXPECT_EQ(script.content_type, "text/javascript; charset=utf-8");
  EXPECT_EQ(script.caching, Caching::for_ever);
}

TEST(AppFiles, NoPathLeadsOutOfTheFolder) {
  const ScratchFolder folder;
  std::filesystem::create_directory(folder / "web");
  put_content(folder / "secret", "secret");
  const AppFiles app(folder / "web");
  for (const char* path : {"/../secret", "/assets/../../secret", "//secret", "/web/../secret", "secret", ""})
    EXPECT_EQ(app.answer(path).status, 404u) << path;
}

TEST(AppFiles, WithoutThemAPageSaysWhatToDo) {
  const ScratchFolder folder;
  const ApiResponse page = AppFiles(folder / "absent").answer("/");
  EXPECT_EQ(page.status, 200u);
  EXPECT_NE(page.body.text().find("rayfarm-web"), std::string_view::npos);
}

}  // namespace
}  // namespace rayfarm
