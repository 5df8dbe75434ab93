#include "tests/common/net/largest_allocation.h"

#include <algorithm>
#include <cstdlib>
#include <new>
#include <utility>

static std::size_t largest = 0;

namespace rayfarm {
std::size_t take_largest_allocation() { return std::exchange(largest, 0); }
}  // namespace rayfarm

void* operator new(std::size_t size) {
  largest = std::max(largest, size);
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
