// Meshes, Bezier surfaces and images as they travel: first as damaged bytes, then as the content of sound ones.
//
// Laws: an asset that was decoded is encoded to the same asset, and rays can meet it.
#include "common/net/compress.h"
#include "tests/fuzz/fuzz.h"

namespace rayfarm {
namespace {

AssetData data_of(Bytes bytes) {
  return {sha256_hex(bytes), std::make_shared<const Bytes>(std::move(bytes))};
}

void decode(Bytes bytes) try {
  const Asset asset = decode_asset(data_of(std::move(bytes)));
  const AssetData once = asset_data(*asset.content());
  require(*asset_data(*decode_asset(once).content()).bytes == *once.bytes,
          "an asset that was sent on is the same asset");
  asset.facets();
} catch (const CodecError&) {}

}  // namespace

void fuzz(ByteView bytes) {
  decode({bytes.begin(), bytes.end()});
  decode(compress(bytes));
}

}  // namespace rayfarm
