// Assets: a format number, then cereal inside one zstd frame.
#include "common/net/asset_cereal.h"
#include "common/net/compress.h"

namespace rayfarm {
namespace {

constexpr std::uint8_t asset_format = 1;
constexpr std::size_t max_raw_asset = std::size_t{1} << 30;  // bytes

}  // namespace

AssetData asset_data(const AssetContent& content) {
  Bytes raw{asset_format};
  encode_to(raw, content);
  auto bytes = std::make_shared<const Bytes>(compress(raw));
  return {sha256_hex(*bytes), bytes};
}

Asset decode_asset(const AssetData& data) {
  if (sha256_hex(*data.bytes) != data.hash) throw CodecError("an asset's bytes do not have the asset's hash");
  DecompressedSource source(*data.bytes, max_raw_asset);
  if (source.sbumpc() != asset_format) throw CodecError("this is no asset that this version can read");
  auto content = decode_from<AssetContent>(source);
  source.expect_end();
  if (const std::string fault = fault_of(content); !fault.empty()) throw CodecError("an asset " + fault);
  return Asset(data.hash, std::move(content));
}

}  // namespace rayfarm
