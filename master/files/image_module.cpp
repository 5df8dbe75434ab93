#include "master/files/image_module.h"

#include <dlfcn.h>

namespace rayfarm {
namespace {

/// In ../lib/rayfarm as seen from the program's folder, both where it was built and where it is installed.
const ImageModule& open_module() {
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::filesystem::path file = programs.parent_path() / "lib" / "rayfarm" / "rayfarm-images.so";
  void* module = ::dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr)
    throw FileError("cannot open the image module: " + std::string(::dlerror()) + "; reinstall rayfarm");
  const auto entry = reinterpret_cast<decltype(&rayfarm_images)>(::dlsym(module, "rayfarm_images"));
  if (entry == nullptr) throw FileError(file.string() + " is not an image module of rayfarm; reinstall it");
  return *entry();
}

}  // namespace

const ImageModule& image_module() {
  static const ImageModule& module = open_module();
  return module;
}

}  // namespace rayfarm
