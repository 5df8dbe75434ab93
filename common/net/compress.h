// Bytes made smaller, without loss, by zstd.
#pragma once
#include <memory>
#include <streambuf>

#include "common/net/codec.h"

namespace rayfarm {

/// Appends the floats in little space: all first bytes, all second ones and so on (exponents are alike and
/// compress, mantissas do not), then zstd. Every bit survives, also of NaNs.
void pack_floats(std::span<const float> floats, Bytes& out);
/// The reverse; throws CodecError unless there are exactly `count` floats in the bytes.
std::vector<float> unpack_floats(ByteView packed, std::size_t count);

/// For large data: one zstd frame with a checksum. The same bytes give the same bytes.
Bytes compress(ByteView bytes);

/// The stream that compress() made small, read piece by piece, so that memory follows what the reader keeps.
class DecompressedSource : public std::streambuf {
 public:
  /// Reading more than `limit` bytes, or damaged ones, throws CodecError. The bytes must outlive the source.
  DecompressedSource(ByteView compressed, std::size_t limit);
  ~DecompressedSource() override;
  /// Throws CodecError unless everything has been read, and the checksum was right.
  void expect_end();

 protected:
  int_type underflow() override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace rayfarm
