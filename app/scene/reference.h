#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace annulus::app {

/// Published statements about a scene, read from a file with their source (data/scenes/reference).
struct Reference {
  /// "The first variant has the largest value, the last the smallest."
  struct Order {
    std::string quantity;               ///< one of comparison.cc's quantities: "ring_stiffness", "load_sharing", ...
    std::vector<std::string> variants;  ///< largest first; a single one: larger than all others
    std::vector<double> values;         ///< published numbers, one per variant, or none
    double margin = 0;  ///< relative difference that the statement asks for ("clearly"); 0: any beyond the error bars
    std::string statement, where;
  };
  /// "Stiffer where a pin stands behind the contact than between the pins."
  struct AtPin {
    std::string ring, statement, where;
  };
  /// A published number of a stage without variants.
  struct Value {
    std::string quantity;  ///< column of a figure of the stage: "frequency_1_Hz"
    double value = 0;
    double within = 0;  ///< relative difference that still counts as agreement
    std::string statement, where;
  };
  std::string source, doi, note;
  std::vector<Order> orders;
  std::vector<AtPin> at_pins;
  std::vector<Value> values;
};

/// Throws InputError naming the file and what is wrong with it.
[[nodiscard]] Reference read_reference(const std::filesystem::path& file);

}  // namespace annulus::app
