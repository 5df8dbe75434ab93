// Memory as the streams that cereal reads and writes.
#pragma once
#include <streambuf>

#include "common/net/codec.h"

namespace rayfarm {

/// Appends what is written to a vector.
class ByteSink : public std::streambuf {
 public:
  explicit ByteSink(Bytes& bytes) : bytes_(bytes) {}

 protected:
  std::streamsize xsputn(const char* data, std::streamsize size) override {
    bytes_.insert(bytes_.end(), data, data + size);
    return size;
  }
  int_type overflow(int_type c) override {
    bytes_.push_back(static_cast<std::uint8_t>(traits_type::to_char_type(c)));
    return c;
  }

 private:
  Bytes& bytes_;
};

/// Reads bytes that must outlive it.
class ByteSource : public std::streambuf {
 public:
  explicit ByteSource(ByteView bytes) {
    char* const data = const_cast<char*>(reinterpret_cast<const char*>(bytes.data()));  // never written to
    setg(data, data, data + bytes.size());
  }
  /// What has not been read yet.
  ByteView rest() const {
    return {reinterpret_cast<const std::uint8_t*>(gptr()), reinterpret_cast<const std::uint8_t*>(egptr())};
  }
};

}  // namespace rayfarm
