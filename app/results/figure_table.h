#pragma once

#include <string>
#include <vector>

#include "core/figure.h"

namespace annulus::app {

/// The results of one of the compared lumped models.
struct VariantFigures {
  std::string name;  ///< empty for kinds without variants
  FigureSet figures;
};

/// figures.csv: a line per result and variant with key, symbol, value, error and quantiles of samples in SI, unit and
/// title for people. In the order of the declarations, those that a variant does not have left out.
[[nodiscard]] std::string figures_csv(const std::vector<FigureSpec>& specs,
                                      const std::vector<VariantFigures>& variants);

/// What `annulus explain` says of a result: title, symbol, unit, definition, and the kinds of gear systems that have
/// it.
[[nodiscard]] std::string explain(const FigureSpec& spec, const std::vector<std::string>& kinds);

}  // namespace annulus::app
