#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace annulus::benchmarks {

/// A ring gear with the module, profile shift and rim of the ring paper and any number of teeth (few teeth: stub teeth,
/// because an involute ends at the base circle).
struct RingCase {
  int teeth = 162;
  int dimension = 2;
  bool cantilever = false;     ///< 3D: held at the end face of a sleeve instead of the outside
  std::optional<int> level{};  ///< the program's own solid resolution; absent: a coarser one for big comparisons
};

[[nodiscard]] std::string describe(const RingCase& ring);

/// Compliance of the working flanks of tooth 0 and of teeth 1, 2 and z/2 further on under unit normal forces on some
/// nodes of the flank of tooth 0.
struct RingCompliance {
  std::vector<Eigen::MatrixXd> blocks;  ///< one per tooth: ports x loaded ports, m/N or, in the plane, m^2/N
  long unknowns = 0;                    ///< of the largest matrix that is factorised
  double discretise_seconds = 0;        ///< mesh and stiffness matrix
  double condense_seconds = 0;          ///< composed: the sector. Monolithic: the factorisation
  double compose_seconds = 0;  ///< composed: all that depends on the number of teeth. Monolithic: the solutions
  double cpu_seconds = 0;      ///< processor time of all three
};

/// One sector condensed to its cuts and all its ports, the ring composed of it. What is timed are the couplings of six
/// neighbours, which is what the program wants; at a level of the program there are no others.
[[nodiscard]] RingCompliance composed(const RingCase& ring, int threads);
/// The whole ring as one system of the same elements.
[[nodiscard]] RingCompliance monolithic(const RingCase& ring);

}  // namespace annulus::benchmarks
