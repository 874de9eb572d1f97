#pragma once

#include <fmt/os.h>

#include <map>

#include "benchmarks/calculix/quadratic_body.h"
#include "fem/problem/support_sites.h"

namespace annulus::benchmarks {

/// Shares of the nodes of a body's support in the mean displacement of an arc of it.
[[nodiscard]] std::map<int, double> support_shares(const QuadraticBody& body, const fem::SupportSite& arc);

/// A body in a deck, whose nodes are numbered from `first_node` + 1.
struct DeckBody {
  const QuadraticBody& body;
  int first_node;
};
/// Makes displacement `component` of the node `reference` the mean one of an arc along the direction at `angle`, rad.
void write_mean_displacement(fmt::ostream& out, const DeckBody& body, const fem::SupportSite& arc, double angle,
                             int reference, int component);

}  // namespace annulus::benchmarks
