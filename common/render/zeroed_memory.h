// Big arrays that begin as zeros at no cost.
//
// calloc takes large blocks fresh from the system, which gives out zero pages at their first use: a film of 6
// GB is there at once, and needs memory only for the tiles that came. A plain vector writes all of it first,
// which takes seconds.
#pragma once
#include <cstddef>
#include <cstdlib>
#include <new>
#include <vector>

namespace rayfarm {

template <class T>
struct ZeroedMemory {
  using value_type = T;

  ZeroedMemory() = default;
  template <class U>
  ZeroedMemory(const ZeroedMemory<U>&) {}

  T* allocate(std::size_t count) {
    void* memory = std::calloc(count, sizeof(T));
    if (memory == nullptr) throw std::bad_alloc();
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, std::size_t) { std::free(memory); }
  /// Of an element without a value: the zero is there already.
  void construct(T*) {}
  template <class... Values>
  void construct(T* element, Values&&... values) {
    ::new (element) T(static_cast<Values&&>(values)...);
  }
  bool operator==(const ZeroedMemory&) const = default;
};

/// To be made whole, never resized: what resize() adds in used memory has no value.
template <class T>
using ZeroedVector = std::vector<T, ZeroedMemory<T>>;

}  // namespace rayfarm
