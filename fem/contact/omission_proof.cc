#include "fem/contact/omission_proof.h"

#include <algorithm>
#include <limits>

#include "fem/contact/contact_evaluation.h"
#include "fem/contact/support_row.h"

namespace annulus::fem {
namespace {

/// Deflections of both bodies at any tooth pair, under the forces of a solved position.
class FlankDeflections {
 public:
  FlankDeflections(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                   const ComplementaritySolution& solution)
      : bodies_(bodies), cycle_(cycle), approach_(bodies.face.normal_factor() * solution.rigid[0]) {
    for (std::size_t i = 0; i < setup.pairs.size(); ++i) {
      const auto& p = setup.pairs[i];
      Eigen::VectorXd force = solution.force.segment(setup.start[i], p.size());
      if ((force.array() != 0).any()) loaded_.push_back({&p, std::move(force)});
    }
    for (const auto& body : floating_unknowns(bodies, setup.contacts))
      (body.row == bodies.supports ? wheel_ : pinion_) = {body.row, row_forces(bodies, setup, body, solution),
                                                          support_motion(body, solution)};
  }

  /// Largest approach of the two flanks along their height, m, in every slice.
  [[nodiscard]] Eigen::VectorXd approach(int pair) const {
    return (approach_ - bodies_.pinion.least_by_slice(pinion(pair)).array() -
            bodies_.wheel.least_by_slice(wheel(pair)).array())
        .matrix();
  }
  /// An upper bound of it, which nearly always suffices.
  [[nodiscard]] Eigen::VectorXd most_approach(int pair) const {
    const int here = wheel_tooth(bodies_.face.flanks(), pair, 0);
    Eigen::VectorXd least_sum = Eigen::VectorXd::Zero(bodies_.pinion.slices());
    for (const auto& [loaded, force] : loaded_)
      least_sum += bodies_.pinion.least_displacement(pair, loaded->pinion, loaded->index, force) +
                   bodies_.wheel.least_displacement(here, loaded->wheel,
                                                    wheel_tooth(bodies_.face.flanks(), loaded->index, 0), force);
    if (pinion_.row != nullptr) least_sum += bodies_.pinion.least_by_slice(floating(pinion_, bodies_.pinion, pair));
    if (wheel_.row != nullptr)
      least_sum += bodies_.wheel.least_by_slice(
          floating(wheel_, bodies_.wheel, wheel_tooth(bodies_.face.flanks(), pair, cycle_)));
    return approach_ - least_sum.array();
  }

 private:
  [[nodiscard]] Eigen::VectorXd pinion(int pair) const {
    Eigen::VectorXd sum = bodies_.pinion.displacement(pair, loaded_.front().pair->pinion, loaded_.front().pair->index,
                                                      loaded_.front().force);
    for (std::size_t i = 1; i < loaded_.size(); ++i)
      sum += bodies_.pinion.displacement(pair, loaded_[i].pair->pinion, loaded_[i].pair->index, loaded_[i].force);
    if (pinion_.row != nullptr) sum += floating(pinion_, bodies_.pinion, pair);
    return sum;
  }

  [[nodiscard]] Eigen::VectorXd wheel(int pair) const {
    const auto& flanks = bodies_.face.flanks();
    // Contact forces are those of cycle 0, which the supports have moved on from.
    const int here = wheel_tooth(flanks, pair, 0);
    Eigen::VectorXd sum;
    for (const auto& [loaded, force] : loaded_) {
      const Eigen::VectorXd part =
          bodies_.wheel.displacement(here, loaded->wheel, wheel_tooth(flanks, loaded->index, 0), force);
      if (sum.size() == 0)
        sum = part;
      else
        sum += part;
    }
    if (wheel_.row != nullptr) sum += floating(wheel_, bodies_.wheel, wheel_tooth(flanks, pair, cycle_));
    return sum;
  }

  /// A body that floats: its supports, and how it moves as a whole.
  struct Floating {
    const SupportRow* row = nullptr;
    Eigen::VectorXd force, motion;
  };
  [[nodiscard]] Eigen::VectorXd floating(const Floating& floating, const ContactBody& body, int tooth) const {
    const Eigen::MatrixXd plane = body.motions(tooth);
    Eigen::VectorXd sum =
        body.slice_means(floating.row->at_flank(tooth, floating.force)) + plane * floating.motion.head<3>();
    if (floating.motion.size() <= 3) return sum;
    const auto& z = bodies_.face.slice_edges();
    for (Eigen::Index i = 0; i < sum.size(); ++i) {
      const auto slice = static_cast<std::size_t>(i) % (z.size() - 1);
      const double middle = (z[slice] + z[slice + 1]) / 2;
      sum[i] += middle * (plane(i, 0) * floating.motion[4] - plane(i, 1) * floating.motion[3]);
    }
    return sum;
  }

  struct Loaded {
    const ToothPair* pair;
    Eigen::VectorXd force;
  };
  ContactBodies bodies_;
  int cycle_;
  double approach_;  // m, by the transmission error, along the normal
  std::vector<Loaded> loaded_;
  Floating pinion_, wheel_;
};

}  // namespace

OmissionProof prove_omissions(const ContactBodies& bodies, const ToothPairs& setup, int cycle,
                              const ComplementaritySolution& solution, double gap_beyond) {
  const FlankDeflections deflections(bodies, setup, cycle, solution);
  OmissionProof proof;
  proof.closest_approach = -std::numeric_limits<double>::infinity();
  for (const auto& omitted : setup.omitted) {
    const auto closed = [&](const Eigen::VectorXd& approach, int s) {
      return omitted.gap + bodies.face.smallest_lead_gap(s) <= approach[s];
    };
    Eigen::VectorXd approach = deflections.most_approach(omitted.pair);
    if (approach.maxCoeff() >= gap_beyond ||
        std::any_of(omitted.slices.begin(), omitted.slices.end(), [&](int s) { return closed(approach, s); }))
      approach = deflections.approach(omitted.pair);
    proof.closest_approach = std::max(proof.closest_approach, approach.maxCoeff());
    for (const int s : omitted.slices)
      if (closed(approach, s)) proof.not_apart.emplace(omitted.pair, s);
  }
  for (const int outermost : {setup.first_pair, setup.last_pair}) {
    if (std::any_of(setup.omitted.begin(), setup.omitted.end(), [&](const auto& o) { return o.pair == outermost; }))
      continue;
    double approach = deflections.most_approach(outermost).maxCoeff();
    if (approach >= gap_beyond) approach = deflections.approach(outermost).maxCoeff();
    proof.closest_approach = std::max(proof.closest_approach, approach);
  }
  return proof;
}

}  // namespace annulus::fem
