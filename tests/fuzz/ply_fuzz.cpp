// PLY files.
#include "tests/fuzz/mesh.h"

namespace rayfarm {

void fuzz(ByteView bytes) { fuzz_mesh("mesh.ply", bytes); }

}  // namespace rayfarm
