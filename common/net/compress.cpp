#include "common/net/compress.h"

#include <zstd.h>

#include <array>
#include <cstring>

namespace rayfarm {
namespace {

constexpr int float_level =
    1;  // rendered mantissas are noise: higher levels gain 2 % and cost ten times more
constexpr int stream_level = 3;
constexpr int window_log = 21;  // 2 MB: also what a stranger's frame can make us allocate

std::size_t checked(std::size_t zstd_result) {
  if (ZSTD_isError(zstd_result))
    throw CodecError(std::string("compressed data is damaged: ") + ZSTD_getErrorName(zstd_result));
  return zstd_result;
}

Bytes shuffled(std::span<const float> floats) {
  Bytes planes(floats.size() * sizeof(float));
  for (std::size_t i = 0; i < floats.size(); ++i) {
    std::array<std::uint8_t, sizeof(float)> bytes;
    std::memcpy(bytes.data(), &floats[i], sizeof(float));
    for (std::size_t b = 0; b < sizeof(float); ++b) planes[b * floats.size() + i] = bytes[b];
  }
  return planes;
}

std::vector<float> unshuffled(const Bytes& planes) {
  std::vector<float> floats(planes.size() / sizeof(float));
  for (std::size_t i = 0; i < floats.size(); ++i) {
    std::array<std::uint8_t, sizeof(float)> bytes;
    for (std::size_t b = 0; b < sizeof(float); ++b) bytes[b] = planes[b * floats.size() + i];
    std::memcpy(&floats[i], bytes.data(), sizeof(float));
  }
  return floats;
}

}  // namespace

void pack_floats(std::span<const float> floats, Bytes& out) {
  const Bytes planes = shuffled(floats);
  const std::size_t before = out.size();
  out.resize(before + ZSTD_compressBound(planes.size()));
  const std::size_t size =
      ZSTD_compress(out.data() + before, out.size() - before, planes.data(), planes.size(), float_level);
  out.resize(before + checked(size));
}

std::vector<float> unpack_floats(ByteView packed, std::size_t count) {
  Bytes planes(count * sizeof(float));
  if (checked(ZSTD_decompress(planes.data(), planes.size(), packed.data(), packed.size())) != planes.size())
    throw CodecError("compressed pixels are fewer than announced");
  return unshuffled(planes);
}

Bytes compress(ByteView bytes) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(), &ZSTD_freeCCtx);
  if (!context) throw std::bad_alloc();
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, stream_level));
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_windowLog, window_log));
  checked(ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1));
  Bytes out(ZSTD_compressBound(bytes.size()));
  out.resize(checked(ZSTD_compress2(context.get(), out.data(), out.size(), bytes.data(), bytes.size())));
  out.shrink_to_fit();
  return out;
}

struct DecompressedSource::State {
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context{ZSTD_createDCtx(), &ZSTD_freeDCtx};
  ZSTD_inBuffer in{};
  std::size_t limit = 0, produced = 0;
  bool ended = false;
  std::array<char, 1 << 16> piece;
};

DecompressedSource::DecompressedSource(ByteView compressed, std::size_t limit)
    : state_(std::make_unique<State>()) {
  if (!state_->context) throw std::bad_alloc();
  checked(ZSTD_DCtx_setParameter(state_->context.get(), ZSTD_d_windowLogMax, window_log));
  state_->in = {compressed.data(), compressed.size(), 0};
  state_->limit = limit;
}

DecompressedSource::~DecompressedSource() = default;

DecompressedSource::int_type DecompressedSource::underflow() {
  State& s = *state_;
  ZSTD_outBuffer out{s.piece.data(), s.piece.size(), 0};
  while (!s.ended && out.pos == 0) {
    const std::size_t consumed = s.in.pos;
    s.ended = checked(ZSTD_decompressStream(s.context.get(), &out, &s.in)) == 0;
    if (!s.ended && out.pos == 0 && s.in.pos == consumed) throw CodecError("compressed data ends too early");
  }
  s.produced += out.pos;
  if (s.produced > s.limit)
    throw CodecError("compressed data holds more than " + std::to_string(s.limit) + " bytes");
  setg(s.piece.data(), s.piece.data(), s.piece.data() + out.pos);
  return out.pos == 0 ? traits_type::eof() : traits_type::to_int_type(s.piece.front());
}

void DecompressedSource::expect_end() {
  if (sgetc() != traits_type::eof() || state_->in.pos != state_->in.size)
    throw CodecError("compressed data is followed by something else");
}

}  // namespace rayfarm
