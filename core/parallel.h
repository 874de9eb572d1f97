#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <vector>

namespace annulus {

/// Calls task(0) ... task(tasks - 1), independent of each other, on `threads` threads; they are started in this order.
/// After a failure no further one is started, and the failure of the first task that has one is thrown: which one that
/// is does not depend on the number of threads.
template <class Task>
void for_each_task(std::size_t tasks, int threads, Task task) {
  std::atomic<std::size_t> next{0};
  std::vector<std::exception_ptr> failures(tasks);
  const auto work = [&] {
    for (std::size_t i = next++; i < tasks; i = next++) {
      try {
        task(i);
      } catch (...) {
        failures[i] = std::current_exception();
        next = tasks;
      }
    }
  };
  std::vector<std::thread> pool;
  // Where the system refuses another thread (ulimit -u, -v) fewer do as well.
  try {
    for (int i = 1; i < threads && static_cast<std::size_t>(i) < tasks; ++i) pool.emplace_back(work);
  } catch (const std::system_error&) {
  } catch (const std::bad_alloc&) {
  }
  work();
  for (auto& thread : pool) thread.join();
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace annulus
