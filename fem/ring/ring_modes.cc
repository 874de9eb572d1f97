#include "fem/ring/ring_modes.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <complex>

#include "core/errors.h"
#include "fem/condensation/lapack.h"

namespace annulus::fem {
namespace {

using Complex = std::complex<double>;

/// `shape`: amplitudes of the motions, motions x sectors; `mesh`: displacements of the mesh forces. Out of the frame of
/// the solve into that of the real ring, its mirror image: y and the sense of rotation change, teeth count backwards.
RingMode make_mode(const RingFlexibility& ring, double frequency, int waves, const Eigen::MatrixXd& shape,
                   const Eigen::VectorXd& mesh) {
  RingMode mode;
  mode.frequency = frequency;
  mode.waves = waves;
  for (int tooth = 0; tooth < ring.teeth; ++tooth) mode.deflection.push_back(-mesh[(ring.teeth - tooth) % ring.teeth]);
  Eigen::Vector3d participation = Eigen::Vector3d::Zero();
  for (int s = 0; s < ring.teeth; ++s)
    participation += ring.resultants_of(s, ring.first_motion(), ring.motions) * shape.col(s);
  mode.translation_x = participation.x();
  mode.translation_y = -participation.y();
  mode.rotation = -participation.z() / ring.base_radius;
  return mode;
}

double frequency_of(double flexibility) { return 1 / (2 * M_PI * std::sqrt(flexibility)); }

/// An eigenvalue of a harmonic.
struct Candidate {
  double frequency = 0;
  int harmonic = 0;
  Eigen::VectorXcd motions;
  Complex mesh = 0;
};

/// Turned so that the deflection is real and positive where there is any, else the largest motion. `mesh_compliance`:
/// of the mesh force by itself; its root times omega is the largest deflection of a mode of unit mass.
void fix_phase(Candidate& c, double mesh_compliance) {
  Eigen::Index largest = 0;
  c.motions.cwiseAbs().maxCoeff(&largest);
  constexpr double none = 1e-7;  // round-off
  const double most = std::sqrt(mesh_compliance) * 2 * M_PI * c.frequency;
  const Complex reference = std::abs(c.mesh) > none * most ? -c.mesh : c.motions[largest];
  const Complex turn = std::conj(reference) / std::abs(reference);
  c.motions *= turn;
  c.mesh *= turn;
}

/// Dominant number of waves of motions seen in the frames of their sectors.
int dominant_waves(const Eigen::MatrixXd& shape) {
  const auto sectors = static_cast<int>(shape.cols());
  int best = 0;
  double most = -1;
  for (int h = 0; h <= sectors / 2; ++h) {
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(shape.rows());
    for (int s = 0; s < sectors; ++s)
      sum += std::polar(1.0, -2 * M_PI * (h * s % sectors) / sectors) * shape.col(s).cast<Complex>();
    const double energy = sum.squaredNorm() * (h == 0 || 2 * h == sectors ? 1 : 2);
    if (energy > most * (1 + 1e-9)) most = energy, best = h;
  }
  return best;
}

}  // namespace

std::vector<RingMode> held_ring_modes(const RingFlexibility& ring, const ModeLimits& limits) {
  std::vector<Candidate> candidates;
  for (int h = 0; h < ring.compliance.harmonics(); ++h) {
    const Eigen::MatrixXcd& all = ring.compliance.harmonic(h);
    const Eigen::MatrixXcd motions = all.block(ring.first_motion(), ring.first_motion(), ring.motions, ring.motions);
    const Eigen::RowVectorXcd mesh = all.row(0).segment(ring.first_motion(), ring.motions);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> solver;
    if (ring.compliance.multiplicity(h) == 1)
      // Real, and its modes are wanted real.
      solver.compute(motions.real().cast<Complex>());
    else
      solver.compute(motions);
    require(solver.info() == Eigen::Success, "the modes of a ring did not converge");
    for (Eigen::Index k = ring.motions - 1; k >= 0; --k) {
      const double flexibility = solver.eigenvalues()[k];
      // Motions that deform the sector and hardly the ring drown in round-off.
      if (flexibility <= 1e-12 * solver.eigenvalues()[ring.motions - 1]) break;
      Candidate c{frequency_of(flexibility), h, solver.eigenvectors().col(k), 0};
      c.mesh = (mesh * c.motions)(0) / flexibility;
      fix_phase(c, all(0, 0).real());
      candidates.push_back(std::move(c));
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.frequency < b.frequency; });

  std::vector<RingMode> modes;
  for (const auto& c : candidates) {
    if (static_cast<int>(modes.size()) >= limits.count || c.frequency > limits.highest_frequency) break;
    const int multiplicity = ring.compliance.multiplicity(c.harmonic);
    const double norm = std::sqrt(static_cast<double>(multiplicity) / ring.teeth);
    for (int part = 0; part < multiplicity; ++part) {
      Eigen::MatrixXd shape(ring.motions, ring.teeth);
      Eigen::VectorXd mesh(ring.teeth);
      for (int s = 0; s < ring.teeth; ++s) {
        const Complex turn = std::polar(norm, 2 * M_PI * (c.harmonic * s % ring.teeth) / ring.teeth) *
                             (part == 0 ? 1.0 : Complex(0, -1));
        shape.col(s) = (turn * c.motions).real();
        mesh[s] = (turn * c.mesh).real();
      }
      modes.push_back(make_mode(ring, c.frequency, c.harmonic, shape, mesh));
    }
  }
  return modes;
}

std::vector<RingMode> supported_ring_modes(const RingFlexibility& ring, const RingOnSupports& supports,
                                           const ModeLimits& limits) {
  const Eigen::MatrixXd all = supports.held_compliance();
  const Eigen::Index teeth = ring.teeth, size = all.rows() - teeth;
  constexpr int spare = 4;  // enough to see whether the last mode is one of a pair
  const auto wanted = static_cast<int>(std::min<Eigen::Index>(size, limits.count + spare));
  const auto [values, vectors] = lapack::largest_eigenpairs(all.bottomRightCorner(size, size), wanted);
  const Eigen::MatrixXd mesh = lapack::product(all.topRightCorner(teeth, size), vectors);
  std::vector<RingMode> modes;
  constexpr double same = 1e-6;  // relative: frequencies of a pair
  for (int k = 0; k < wanted && values[k] > 1e-12 * values[0]; ++k) {
    const double frequency = frequency_of(values[k]);
    const bool second = k > 0 && frequency < (1 + same) * modes.back().frequency;
    if (frequency > limits.highest_frequency || (k >= limits.count && !second)) break;
    const Eigen::MatrixXd shape = vectors.col(k).reshaped(ring.motions, teeth);
    RingMode mode = make_mode(ring, frequency, dominant_waves(shape), shape, mesh.col(k) / values[k]);
    // The sign is free: the largest deflection is positive.
    const auto largest = std::max_element(mode.deflection.begin(), mode.deflection.end(),
                                          [](double a, double b) { return std::abs(a) < (1 - 1e-9) * std::abs(b); });
    if (*largest < 0) {
      for (double& c : mode.deflection) c = -c;
      for (double* p : {&mode.translation_x, &mode.translation_y, &mode.rotation}) *p = -*p;
    }
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace annulus::fem
