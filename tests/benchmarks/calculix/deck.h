#pragma once

#include <fmt/os.h>

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/material.h"

/// What all input decks of CalculiX have in common. It is given mm, N and MPa: some of its tolerances are absolute and
/// made for such numbers. Bodies are slices of plane strain, 1 mm wide.
namespace annulus::benchmarks {

inline constexpr double deck_mm = 1e-3, deck_MPa = 1e6, slice_width = 1;  ///< the last in mm

/// Free fields of an input deck are read to 20 characters only.
[[nodiscard]] std::string deck_field(double value);
/// A stiffness, N/mm: *SPRING reads whole numbers as degrees of freedom, so that it needs a decimal point.
[[nodiscard]] std::string spring_field(double value);
struct DeckTerm {
  int node, component;
  double factor;
};
using DeckEquation = std::vector<DeckTerm>;
/// The terms add up to zero; the first one is determined by the others.
void write_equation(fmt::ostream& out, const DeckEquation& equation);
/// Nodes and cells of a body, numbered from `first_node` + 1 and `first_cell` + 1.
void write_body(fmt::ostream& out, const QuadraticBody& body, const std::string& name, int first_node, int first_cell);
void write_material(fmt::ostream& out, const fem::Material& material, const std::vector<std::string>& parts);
/// Frictionless flanks with a penalty, Pa/m.
void write_interaction(fmt::ostream& out, double contact_stiffness);

struct DeckRun {
  double wall_seconds = 0, cpu_seconds = 0;
  int iterations = 0;
  std::string failure{};  ///< empty: none
};
/// Displacements (mm, or rad) of the nodes of a set at the end of every step, from job.dat. A step takes a second.
[[nodiscard]] std::vector<std::map<int, Eigen::Vector2d>> read_displacements(const std::filesystem::path& file,
                                                                             const std::string& set);
/// Runs job.inp in a folder; job.dat is there afterwards.
[[nodiscard]] DeckRun run_deck(const std::filesystem::path& folder, int threads);

}  // namespace annulus::benchmarks
