#include "tests/dynamics/allocation_counter.h"

#include <cstdlib>
#include <new>

static long allocation_count = 0;

long allocations() { return allocation_count; }

// In a file of its own: inlined into callers the compiler mistakes the pair malloc and free for a mismatch.
void* operator new(std::size_t size) {
  ++allocation_count;
  if (void* memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocation_count;
  return std::malloc(size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
