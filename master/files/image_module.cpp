#include "master/files/image_module.h"

#include <dlfcn.h>

namespace rayfarm {
namespace {

/// Beside the program, or in ../lib/rayfarm as seen from its folder, both where it was built and where it is installed.
std::filesystem::path module_file() {
  const std::filesystem::path programs = std::filesystem::read_symlink("/proc/self/exe").parent_path();
  const std::filesystem::path beside = programs / "rayfarm-images.so";
  if (std::filesystem::exists(beside)) return beside;
  return programs.parent_path() / "lib" / "rayfarm" / "rayfarm-images.so";
}

const ImageModule& open_module() {
  const std::filesystem::path file = module_file();
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
