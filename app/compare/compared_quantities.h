#pragma once

#include <string>
#include <vector>

#include "app/compare/compared_run.h"
#include "app/model/measured.h"
#include "core/figure.h"

namespace annulus::app {

/// A result over all variants of all runs.
struct ComparedQuantity {
  FigureSpec spec;                         ///< in a unit that suits all variants
  VariantQuantity si{};                    ///< the variants that have it
  VariantQuantity shown{};                 ///< the same in that unit, which its name states
  std::vector<std::string> cells{};        ///< of all variants, with errors; "–" where one does not have it
  std::vector<std::string> spreads{};      ///< of all variants; "–" where one has no samples
  bool has_spread = false;                 ///< of any variant
  std::vector<std::string> differences{};  ///< every other variant against the first one, in words
};

/// An input that is not the same everywhere: its value in every variant, "–" where it has none.
struct DifferingInput {
  std::string key;
  std::vector<std::string> values;
};
[[nodiscard]] std::vector<DifferingInput> differing_inputs(const std::vector<ComparedRun>& runs);

/// Finished runs side by side: what text, table and page show.
struct Comparison {
  explicit Comparison(const std::vector<ComparedRun>& runs);

  std::vector<std::string> variants{};         ///< in the order of the runs
  std::vector<ComparedQuantity> quantities{};  ///< those that at least one variant has
  std::vector<DifferingInput> inputs{};
};

}  // namespace annulus::app
