#pragma once

#include <Eigen/Core>
#include <cstring>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <variant>

#include "core/csv.h"
#include "core/errors.h"
#include "core/figure.h"
#include "core/ring_coupling.h"
#include "core/stiffness_table.h"

/// Values as bytes and back, bit by bit: what is cached of a result, and the identity of what it depends on. The bytes
/// are meant for the build that wrote them (ResultStore finds no others).
namespace annulus {

/// The members of a struct, declared by ANNULUS_MEMBERS. Classes that keep theirs to themselves have a specialisation
/// with `pass` instead.
template <class T>
struct Members;

/// ANNULUS_MEMBERS(Type, a, b, c); in namespace annulus: all data members in their order. One that is left out does not
/// compile.
#define ANNULUS_MEMBERS(Type, ...)  \
  template <>                       \
  struct Members<Type> {            \
    template <class Whole>          \
    static auto of(Whole& whole) {  \
      auto& [__VA_ARGS__] = whole;  \
      return std::tie(__VA_ARGS__); \
    }                               \
  }

class ByteWriter {
 public:
  static constexpr bool reads = false;
  void raw(const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); }
  std::string bytes;
};

class ByteReader {
 public:
  static constexpr bool reads = true;
  explicit ByteReader(std::string_view bytes) : rest_(bytes) {}
  void raw(void* data, std::size_t size) {
    require(size <= rest_.size(), "cached bytes hold a whole value");
    if (size > 0) std::memcpy(data, rest_.data(), size);
    rest_.remove_prefix(size);
  }

 private:
  std::string_view rest_;
};

/// Hands every part of a value to the archive, which writes it or sets it.
template <class Archive, class T>
void pass(Archive& archive, T& value) {
  constexpr bool reads = Archive::reads;
  const auto counted = [&](std::size_t count) {
    archive.raw(&count, sizeof count);
    return count;
  };
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    archive.raw(&value, sizeof value);
  } else if constexpr (std::is_base_of_v<Eigen::EigenBase<T>, T>) {
    const auto rows = counted(static_cast<std::size_t>(value.rows())),
               columns = counted(static_cast<std::size_t>(value.cols()));
    if constexpr (reads) value.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
    archive.raw(value.data(), rows * columns * sizeof(typename T::Scalar));
  } else if constexpr (requires { value.has_value(); }) {
    if (counted(value.has_value() ? 1 : 0) == 0) return;
    if constexpr (reads) value.emplace();
    pass(archive, *value);
  } else if constexpr (requires { typename T::element_type; }) {
    using Content = std::remove_const_t<typename T::element_type>;
    if (counted(value ? 1 : 0) == 0) return;
    if constexpr (reads) value = std::make_shared<Content>();
    pass(archive, const_cast<Content&>(*value));
  } else if constexpr (requires { typename T::mapped_type; }) {
    const auto count = counted(value.size());
    auto entry = value.begin();
    for (std::size_t i = 0; i < count; ++i) {
      typename T::key_type key;
      if constexpr (!reads) key = entry->first;
      pass(archive, key);
      if constexpr (reads) entry = value.emplace(std::move(key), typename T::mapped_type{}).first;
      pass(archive, entry->second);
      if constexpr (!reads) ++entry;
    }
  } else if constexpr (requires { value.resize(std::size_t{}); }) {
    const auto count = counted(value.size());
    if constexpr (reads) value.resize(count);
    if constexpr (std::is_arithmetic_v<typename T::value_type>)
      archive.raw(value.data(), count * sizeof(typename T::value_type));
    else
      for (auto& element : value) pass(archive, element);
  } else if constexpr (requires { value.index(); }) {
    static_assert(!reads, "alternatives are written only, as inputs");
    counted(value.index());
    std::visit([&](auto& alternative) { pass(archive, alternative); }, value);
  } else if constexpr (requires { std::tuple_size<T>::value; }) {
    std::apply([&](auto&... parts) { (pass(archive, parts), ...); }, value);
  } else if constexpr (requires { Members<T>::pass(archive, value); }) {
    Members<T>::pass(archive, value);
  } else {
    std::apply([&](auto&... members) { (pass(archive, members), ...); }, Members<T>::of(value));
  }
}

template <class... Values>
[[nodiscard]] std::string to_bytes(const Values&... values) {
  ByteWriter writer;
  (pass(writer, const_cast<Values&>(values)), ...);  // a writer changes nothing
  return std::move(writer.bytes);
}

template <class T>
[[nodiscard]] T from_bytes(std::string_view bytes) {
  T value;
  ByteReader reader(bytes);
  pass(reader, value);
  return value;
}

ANNULUS_MEMBERS(Csv, header, columns, rows, file);
ANNULUS_MEMBERS(ErrorParts, discretisation, contact, condensation, interpolation, integration, model);
ANNULUS_MEMBERS(Figure, value, error);
ANNULUS_MEMBERS(Spread, low, median, high, samples);
ANNULUS_MEMBERS(FigureSet::Entry, key, figure, parts, spread);
ANNULUS_MEMBERS(StiffnessEntry, unloaded_te, lte, secant, tangent, error_relative, error_parts);
ANNULUS_MEMBERS(RingMode, frequency, waves, deflection, translation_x, translation_y, rotation);
ANNULUS_MEMBERS(RingCoupling, planets, ring_teeth, load, compliance, per_cycle, modes, mass, rotational_mass,
                provenance);

template <>
struct Members<FigureSet> {
  template <class Archive>
  static void pass(Archive& archive, FigureSet& figures) {
    auto entries = figures.entries();
    annulus::pass(archive, entries);
    if constexpr (Archive::reads)
      for (const auto& entry : entries) figures.set(entry.key, entry.figure, entry.parts);
  }
};

template <>
struct Members<StiffnessTable> {
  template <class Archive>
  static void pass(Archive& archive, StiffnessTable& table) {
    auto mesh = table.mesh();
    auto phases = table.phases();
    auto angles = table.ring_angles(), loads = table.loads();
    std::vector<StiffnessEntry> entries;
    if constexpr (!Archive::reads)
      for (int position = 0; position < table.positions(); ++position)
        for (int phase = 0; phase < phases; ++phase)
          for (int load = 0; load < static_cast<int>(loads.size()); ++load)
            entries.push_back(table.at(position, phase, load));
    auto provenance = table.provenance;
    const auto each = [&](auto&... parts) { (annulus::pass(archive, parts), ...); };
    each(mesh, phases, angles, loads, entries, provenance);
    if constexpr (Archive::reads) {
      if (phases > 0) table = {mesh, phases, std::move(angles), std::move(loads), std::move(entries)};
      table.provenance = std::move(provenance);
    }
  }
};

}  // namespace annulus
