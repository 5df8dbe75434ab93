#include "master/files/texture_image.h"

#include "common/scene/scene.h"
#include "master/files/image_module.h"

namespace rayfarm {

Image read_texture_image(const std::string& name, std::string_view bytes) {
  Image image;
  try {
    image = image_module().texture(name, bytes);
  } catch (const FileError& error) {
    throw SceneError(error.what());
  }
  if (const std::string fault = fault_of(image); !fault.empty()) throw SceneError(name + " " + fault);
  return image;
}

void prepare_to_read_images() { image_module(); }

}  // namespace rayfarm
