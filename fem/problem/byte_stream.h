#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/errors.h"

/// Values as bytes and back, bit by bit: numbers, text, vectors, matrices, and every type `T` for which there is
///
///     template <class Stream>
///     void members(Stream& stream, T& value) { stream(value.first, value.second); }
///
/// which serves both directions.
namespace annulus::fem {

class ByteWriter {
 public:
  template <class... T>
  void operator()(const T&... values) {
    (add(values), ...);
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }

 private:
  template <class T>
  void add(const T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
      raw(&value, sizeof value);
    else
      members(*this, const_cast<T&>(value));  // a writer changes nothing
  }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    raw(text.data(), text.size());
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) add(value);
  }
  template <class T, int rows, int columns>
  void add(const Eigen::Matrix<T, rows, columns>& matrix) {
    add(static_cast<std::uint64_t>(matrix.rows()));
    add(static_cast<std::uint64_t>(matrix.cols()));
    raw(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
  }
  void raw(const void* bytes, std::size_t count) { bytes_.append(static_cast<const char*>(bytes), count); }

  std::string bytes_;
};

/// Reads back what a ByteWriter wrote. Throws Error where there are fewer bytes than a size announces.
class ByteReader {
 public:
  /// `bytes` are referred to.
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}

  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }

 private:
  template <class T>
  void get(T& value) {
    if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>)
      raw(&value, sizeof value);
    else
      members(*this, value);
  }
  void get(std::string& text) {
    text.resize(count());
    raw(text.data(), text.size());
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(count());
    for (auto& value : values) get(value);
  }
  template <class T, int rows, int columns>
  void get(Eigen::Matrix<T, rows, columns>& matrix) {
    const std::size_t m = count(), n = count();
    if (n > 0 && m > left_.size() / sizeof(T) / n)
      ends_early("a matrix of " + std::to_string(m) + " x " + std::to_string(n) + " values");
    matrix.resize(static_cast<Eigen::Index>(m), static_cast<Eigen::Index>(n));
    raw(matrix.data(), sizeof(T) * m * n);
  }
  /// A number of values; each takes a byte at least.
  std::size_t count() {
    std::uint64_t n = 0;
    get(n);
    if (n > left_.size()) ends_early(std::to_string(n) + " values");
    return n;
  }
  void raw(void* bytes, std::size_t count) {
    if (count > left_.size()) ends_early(std::to_string(count) + " bytes");
    if (count > 0) std::memcpy(bytes, left_.data(), count);
    left_.remove_prefix(count);
  }
  [[noreturn]] void ends_early(const std::string& needed) const {
    throw Error("a stream that ends too early: " + needed + " needed, " + std::to_string(left_.size()) + " bytes left");
  }

  std::string_view left_;
};

}  // namespace annulus::fem
