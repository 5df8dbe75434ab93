// How our containers look in cereal's portable binary, and the two calls that encode and decode a value.
// Stands in for cereal's own type headers: those trust a length before the data has come (nine bytes make
// vector<float> allocate 1 GB), read any byte into a bool, and any number into an enum.
#pragma once
#include <cereal/archives/portable_binary.hpp>
#include <cereal/cereal.hpp>
#include <glm/glm.hpp>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <variant>
#include <vector>

#include "common/net/byte_stream.h"
#include "common/net/text.h"

namespace rayfarm {

constexpr std::size_t max_name = 256;   // bytes of a worker's, job's or node's name
constexpr std::size_t max_text = 4096;  // bytes of a reason

template <class Archive>
constexpr bool is_loading = Archive::is_loading::value;

/// Text of at most `limit` bytes that can be shown as it is, on both sides.
template <class Archive>
void text(Archive& archive, std::string& value, std::size_t limit) {
  auto size = static_cast<std::uint32_t>(value.size());
  archive(size);
  if (size > limit)
    throw CodecError("a text of " + std::to_string(size) + " bytes is longer than " + std::to_string(limit));
  if constexpr (is_loading<Archive>) value.resize(size);
  archive(cereal::binary_data(value.data(), size));
  if (!is_plain_text(value)) throw CodecError("a text is not one line of UTF-8 without control characters");
}

/// An enum whose values are 0 to `last`.
template <class Archive, class Enum>
void enumeration(Archive& archive, Enum& value, Enum last) {
  auto number = static_cast<std::underlying_type_t<Enum>>(value);
  archive(number);
  if (number > static_cast<std::underlying_type_t<Enum>>(last))
    throw CodecError("there is no choice of number " + std::to_string(number));
  value = static_cast<Enum>(number);
}

template <class Archive>
void boolean(Archive& archive, bool& value) {
  std::uint8_t byte = value;
  archive(byte);
  if (byte > 1) throw CodecError("a yes or no is neither");
  value = byte == 1;
}

template <class T>
void encode_to(Bytes& out, const T& value) {
  ByteSink sink(out);
  std::ostream stream(&sink);
  cereal::PortableBinaryOutputArchive archive(stream,
                                              cereal::PortableBinaryOutputArchive::Options::LittleEndian());
  archive(value);
}

template <class T>
T decode_from(std::streambuf& source) try {
  std::istream stream(&source);
  cereal::PortableBinaryInputArchive archive(stream);
  T value{};
  archive(value);
  return value;
} catch (const cereal::Exception&) {
  throw CodecError("the data ends too early");
}

}  // namespace rayfarm

namespace cereal {

template <class Archive>
void serialize(Archive& archive, glm::dvec3& v) {
  archive(v.x, v.y, v.z);
}

template <class Archive, class T>
void save(Archive& archive, const std::vector<T>& values) {
  archive(static_cast<std::uint32_t>(values.size()));
  for (const T& value : values) archive(value);
}

/// Grows as elements come, whatever length was announced.
template <class Archive, class T>
void load(Archive& archive, std::vector<T>& values) {
  static_assert(!std::is_empty_v<T>, "an element without bytes makes any length come true");
  std::uint32_t count = 0;
  archive(count);
  values.clear();
  for (std::uint32_t i = 0; i < count; ++i) archive(values.emplace_back());
}

template <class Archive, class T>
void save(Archive& archive, const std::optional<T>& value) {
  archive(static_cast<std::uint8_t>(value.has_value()));
  if (value) archive(*value);
}

template <class Archive, class T>
void load(Archive& archive, std::optional<T>& value) {
  bool present = false;
  rayfarm::boolean(archive, present);
  value.reset();
  if (present) archive(value.emplace());
}

template <class Archive, class... Ts>
void save(Archive& archive, const std::variant<Ts...>& value) {
  archive(static_cast<std::uint8_t>(value.index()));
  std::visit([&](const auto& alternative) { archive(alternative); }, value);
}

template <class Archive, class... Ts>
void load(Archive& archive, std::variant<Ts...>& value) {
  using Variant = std::variant<Ts...>;
  using Load = void (*)(Archive&, Variant&);
  constexpr Load loads[] = {[](Archive& from, Variant& to) { from(to.template emplace<Ts>()); }...};
  std::uint8_t index = 0;
  archive(index);
  if (index >= sizeof...(Ts))
    throw rayfarm::CodecError("there is no kind of number " + std::to_string(index));
  loads[index](archive, value);
}

}  // namespace cereal
