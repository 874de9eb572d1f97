#pragma once

#include <string>
#include <vector>

#include "app/compare/compared_run.h"
#include "app/model/measured.h"
#include "core/figure.h"

namespace annulus::app {

/// A figure over all variants of all runs, SI.
struct ComparedQuantity {
  FigureSpec spec;
  RingQuantity quantity;  ///< the variants that have it
};
/// Those that at least one variant has.
[[nodiscard]] std::vector<ComparedQuantity> compared_quantities(const std::vector<ComparedRun>& runs);

/// The quantity in the unit people read it in.
[[nodiscard]] RingQuantity in_unit(const ComparedQuantity& compared);

/// Every other variant against the first one, in words.
[[nodiscard]] std::vector<std::string> difference_texts(const ComparedQuantity& compared);

/// All variants, in the order of the runs.
[[nodiscard]] std::vector<const ComparedVariant*> all_variants(const std::vector<ComparedRun>& runs);

/// An input that is not the same everywhere: its value in every variant, "–" where it has none.
struct DifferingInput {
  std::string key;
  std::vector<std::string> values;
};
[[nodiscard]] std::vector<DifferingInput> differing_inputs(const std::vector<ComparedRun>& runs);
/// What the inputs cannot tell: runs that do not list them. Empty: they all do.
[[nodiscard]] std::string unknown_inputs_text(const std::vector<ComparedRun>& runs);

}  // namespace annulus::app
