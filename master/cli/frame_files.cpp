#include "master/cli/frame_files.h"

#include <filesystem>

#include "common/render/settings.h"

namespace rayfarm {
namespace {

struct Place {
  std::size_t begin = 0, digits = 0;  // no digits: none
};

/// In the file's name, not in those of its folders.
Place place_in(const std::string& file) {
  const std::size_t name = file.find_last_of('/') + 1;  // npos + 1 is 0
  const std::size_t last = file.find_last_of('#');
  if (last == std::string::npos || last < name) return {};
  const std::size_t before = file.find_last_not_of('#', last);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return {begin, last + 1 - begin};
}

}  // namespace

bool has_place_for_frame(const std::string& file) { return place_in(file).digits > 0; }

std::string frame_file(const std::string& pattern, std::uint32_t frame) {
  const Place place = place_in(pattern);
  if (place.digits == 0) return pattern;
  std::string number = std::to_string(frame);
  if (number.size() < place.digits) number.insert(0, place.digits - number.size(), '0');
  return std::string(pattern).replace(place.begin, place.digits, number);
}

void expect_place_for_frame(const std::string& option, const std::string& file) {
  if (has_place_for_frame(file)) return;
  const std::filesystem::path path(file);
  const std::filesystem::path example =
      path.parent_path() / (path.stem().string() + ".####" + path.extension().string());
  throw SettingsError(option + " must say where the frames' numbers go, as in " + example.string() + "; is " +
                      file);
}

}  // namespace rayfarm
