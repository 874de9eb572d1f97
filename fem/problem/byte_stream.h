#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <istream>
#include <ostream>
#include <string>
#include <type_traits>
#include <vector>

#include "core/errors.h"

namespace annulus::fem {

/// Numbers, and vectors and matrices of them, bit by bit into a stream.
class ByteWriter {
 public:
  explicit ByteWriter(std::ostream& out) : out_(out) {}

  template <class T>
  ByteWriter& add(const T& value) {
    static_assert(std::is_arithmetic<T>::value || std::is_enum<T>::value, "a type without a plain value");
    raw(&value, sizeof value);
    return *this;
  }
  template <class T>
  ByteWriter& add(const std::vector<T>& values) {
    add(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) add(value);
    return *this;
  }
  template <class T, int rows, int columns>
  ByteWriter& add(const Eigen::Matrix<T, rows, columns>& matrix) {
    add(static_cast<std::uint64_t>(matrix.rows())).add(static_cast<std::uint64_t>(matrix.cols()));
    raw(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
    return *this;
  }
  ByteWriter& add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    raw(text.data(), text.size());
    return *this;
  }

 private:
  void raw(const void* bytes, std::size_t count) {
    out_.write(static_cast<const char*>(bytes), static_cast<std::streamsize>(count));
  }
  std::ostream& out_;
};

/// Reads back what a ByteWriter wrote. Throws Error where the stream has less left than a size announces.
class ByteReader {
 public:
  /// `left`: bytes of the stream.
  ByteReader(std::istream& in, std::uint64_t left) : in_(in), left_(left) {}

  template <class T>
  T get() {
    T value{};
    raw(&value, sizeof value);
    return value;
  }
  template <class T>
  void get(T& value) {
    static_assert(std::is_arithmetic<T>::value || std::is_enum<T>::value, "a type without a plain value");
    raw(&value, sizeof value);
  }
  template <class T>
  void get(std::vector<T>& values) {
    values.resize(count(1));
    for (auto& value : values) get(value);
  }
  template <class T, int rows, int columns>
  void get(Eigen::Matrix<T, rows, columns>& matrix) {
    const std::uint64_t most = left_ / sizeof(T), m = count(0), n = count(0);
    if (m > most || n > most || (n > 0 && m > most / n)) throw Error("a stream that ends too early");
    const auto given_rows = static_cast<Eigen::Index>(m), given_columns = static_cast<Eigen::Index>(n);
    if ((rows >= 0 && given_rows != rows) || (columns >= 0 && given_columns != columns))
      throw Error("a matrix of another size");
    matrix.resize(given_rows, given_columns);
    raw(matrix.data(), sizeof(T) * static_cast<std::size_t>(matrix.size()));
  }
  void get(std::string& text) {
    text.resize(count(1));
    raw(&text[0], text.size());
  }

 private:
  /// A number of things of at least `size` bytes each.
  std::uint64_t count(std::uint64_t size) {
    const auto n = get<std::uint64_t>();
    if (size > 0 && n > left_ / size) throw Error("a stream that ends too early");
    return n;
  }
  void raw(void* bytes, std::size_t count) {
    if (count > left_ || !in_.read(static_cast<char*>(bytes), static_cast<std::streamsize>(count)))
      throw Error("a stream that ends too early");
    left_ -= count;
  }
  std::istream& in_;
  std::uint64_t left_;
};

}  // namespace annulus::fem
