#include "dynamics/steady_state/sampled_meshes.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace annulus::dynamics {

using Contact = LumpedSystem::Contact;

namespace {

double damping_in(const MeshElement& mesh, Contact contact) {
  return contact != Contact::open || mesh.damping_without_contact ? mesh.damping : 0.0;
}

/// All pairs of meshes that laws, faces and couplings join, and every mesh with itself.
std::vector<std::pair<Eigen::Index, Eigen::Index>> coupled_pairs(const LumpedSystem& system) {
  std::vector<std::size_t> group(system.meshes().size());
  std::iota(group.begin(), group.end(), std::size_t{0});
  const auto join = [&](int a, int b) {
    const auto from = group[static_cast<std::size_t>(b)], to = group[static_cast<std::size_t>(a)];
    std::replace(group.begin(), group.end(), from, to);
  };
  for (const auto& coupling : system.couplings())
    for (const int m : coupling.meshes) join(coupling.meshes.front(), m);
  for (const auto& element : system.laws())
    for (const int m : element.meshes) join(element.meshes.front(), m);
  for (const auto& face : system.faces()) join(face.approach, face.tilt);
  std::vector<std::pair<Eigen::Index, Eigen::Index>> pairs;
  for (std::size_t i = 0; i < group.size(); ++i)
    for (std::size_t j = 0; j < group.size(); ++j)
      if (group[i] == group[j]) pairs.emplace_back(i, j);
  return pairs;
}

}  // namespace

SampledMeshes::SampledMeshes(const LumpedSystem& system, double period, Eigen::Index samples)
    : system_(system), workspace_(system.workspace()), samples_(samples), step_(period / static_cast<double>(samples)) {
  const auto meshes = static_cast<Eigen::Index>(system.meshes().size());
  tangent_.resize(samples, meshes);
  damping_.resize(samples, meshes);
  for (auto* v : {&approach_, &rate_, &moved_, &force_}) v->resize(meshes);
  whole_.resize(system.meshes().size());
  if (system.has_coupled_meshes()) {
    pairs_ = coupled_pairs(system);
    coupled_.resize(samples, std::ssize(pairs_));
    block_.resize(meshes, meshes);
  }
  if (!std::isfinite(system.next_jump(0))) return;
  pieces_.resize(static_cast<std::size_t>(samples));
  for (Eigen::Index i = 0; i < samples; ++i) {
    const double end = time(i) + step_ / 2;
    for (double begin = time(i) - step_ / 2; begin < end;) {
      const double stop = std::min(end, system.next_jump(begin));
      pieces_[i].push_back({(stop - begin) / step_, (begin + stop) / 2});
      begin = stop;
    }
  }
}

void SampledMeshes::at_deflection(const Eigen::VectorXd& delta, Eigen::MatrixXd& approach, Eigen::MatrixXd& rate) {
  approach.resize(samples_, delta.size());
  rate.resize(samples_, delta.size());
  for (Eigen::Index i = 0; i < samples_; ++i) {
    system_.evaluate_excitation(time(i), workspace_);
    for (Eigen::Index m = 0; m < delta.size(); ++m) {
      approach(i, m) = delta[m] + workspace_.error[m];
      rate(i, m) = workspace_.error_rate[m];
    }
  }
}

void SampledMeshes::evaluate(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate, Eigen::MatrixXd& force) {
  force.resize(samples_, approach.cols());
  tangent_.setZero();
  damping_.setZero();
  coupled_.setZero();
  for (Eigen::Index i = 0; i < samples_; ++i) {
    approach_ = approach.row(i);
    rate_ = rate.row(i);
    force_.setZero();
    if (pieces_.empty()) {
      add_piece(i, {1, time(i)});
    } else {
      for (const auto& piece : pieces_[i]) {
        system_.hold_waves(piece.middle, workspace_);
        approach_ = approach.row(i) + (piece.middle - time(i)) * rate.row(i);
        add_piece(i, piece);
      }
    }
    force.row(i) = force_;
  }
}

void SampledMeshes::add_piece(Eigen::Index sample, const Piece& piece) {
  const double weight = piece.weight, shift = piece.middle - time(sample);
  auto& w = workspace_;
  const auto& meshes = system_.meshes();
  system_.evaluate_forces(piece.middle, approach_.data(), rate_.data(), w);
  const bool coupled = !pairs_.empty();
  if (coupled) {
    system_.tangent_matrix(w, block_);
    for (std::size_t k = 0; k < pairs_.size(); ++k)
      coupled_(sample, static_cast<Eigen::Index>(k)) += weight * block_(pairs_[k].first, pairs_[k].second);
  }
  bool all_whole = true;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const double half = meshes[m].half_backlash.value_or(0.0);
    const double edge = std::abs(std::abs(w.delta[m]) - half);
    whole_[m] = coupled || half == 0 || edge >= std::abs(w.delta_rate[m]) * step_ / 2;
    all_whole = all_whole && whole_[m];
    const auto i = static_cast<Eigen::Index>(m);
    if (whole_[m]) {
      force_[i] += weight * w.force[m];
      tangent_(sample, i) += weight * w.tangent[m];
      damping_(sample, i) += weight * (w.damping[m] + shift * w.tangent[m]);
    } else if (meshes[m].damping_without_contact) {
      force_[i] += weight * meshes[m].damping * w.delta_rate[m];
      damping_(sample, i) += weight * meshes[m].damping;
    }
  }
  if (all_whole) return;
  add_partial_contact(sample, piece, +1);
  add_partial_contact(sample, piece, -1);
}

void SampledMeshes::add_partial_contact(Eigen::Index sample, const Piece& piece, int side) {
  const double weight = piece.weight, shift = piece.middle - time(sample);
  // Within the step the deflection is delta + delta' tau, |tau| <= step/2. It lies beyond the edge, side x half, in the
  // share (d + s)/(2 s) of the step, by (d + s)/2 in the mean: d = side delta - half, s = |delta'| step/2. The force
  // there is the one at that mean.
  auto& w = workspace_;
  const auto& meshes = system_.meshes();
  moved_ = approach_;
  bool any = false;
  const auto inside = [&](std::size_t m) {
    const auto i = static_cast<Eigen::Index>(m);
    const double delta = approach_[i] - w.error[m], swing = std::abs(rate_[i] - w.error_rate[m]) * step_ / 2;
    return std::pair(side * delta - *meshes[m].half_backlash, swing);
  };
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (whole_[m]) continue;
    const auto [depth, swing] = inside(m);
    if (std::abs(depth) >= swing) continue;
    any = true;
    moved_[static_cast<Eigen::Index>(m)] += side * ((depth + swing) / 2 - depth);
  }
  if (!any) return;
  system_.evaluate_forces(piece.middle, moved_.data(), rate_.data(), w);
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    if (whole_[m]) continue;
    const auto [depth, swing] = inside(m);
    if (std::abs(depth) >= swing) continue;
    const auto i = static_cast<Eigen::Index>(m);
    const double open = damping_in(meshes[m], Contact::open), closed = meshes[m].damping;
    const double share = (depth + swing) / (2 * swing), rate = w.delta_rate[m];
    const double gain = w.force[m] - open * rate;  // by touching
    const double share_by_swing = -depth / (2 * swing * swing), swing_by_rate = (rate > 0 ? 0.5 : -0.5) * step_;
    force_[i] += weight * share * gain;
    const double tangent = side * gain / (2 * swing) + share * w.tangent[m] / 2;
    tangent_(sample, i) += weight * tangent;
    damping_(sample, i) +=
        weight * (shift * tangent + (share_by_swing * gain + share * side * w.tangent[m] / 2) * swing_by_rate +
                  share * (closed - open));
  }
}

void SampledMeshes::apply_tangent(const Eigen::Ref<const Eigen::MatrixXd>& change, const Eigen::VectorXd& mean,
                                  Eigen::Ref<Eigen::MatrixXd> force) const {
  const bool coupled = !pairs_.empty();
  for (Eigen::Index m = 0; m < change.cols(); ++m)
    if (coupled)
      force.col(m) = -mean[m] * change.col(m);
    else
      force.col(m).array() = (tangent_.col(m).array() - mean[m]) * change.col(m).array();
  for (std::size_t k = 0; k < pairs_.size(); ++k)
    force.col(pairs_[k].first).array() +=
        coupled_.col(static_cast<Eigen::Index>(k)).array() * change.col(pairs_[k].second).array();
}

void SampledMeshes::evaluate_at_instants(const Eigen::MatrixXd& approach, const Eigen::MatrixXd& rate,
                                         Eigen::MatrixXd& force, std::vector<Contact>& contact) {
  force.resize(samples_, approach.cols());
  contact.resize(static_cast<std::size_t>(force.size()));
  for (Eigen::Index i = 0; i < samples_; ++i) {
    approach_ = approach.row(i);
    rate_ = rate.row(i);
    if (!pieces_.empty()) system_.hold_waves((time(i) + system_.next_jump(time(i))) / 2, workspace_);
    system_.evaluate_forces(time(i), approach_.data(), rate_.data(), workspace_);
    for (Eigen::Index m = 0; m < force.cols(); ++m) {
      force(i, m) = workspace_.force[m];
      // A mesh without backlash is always held closed, and its flanks follow from its force.
      contact[m * samples_ + i] = workspace_.elastic[m] < 0 ? Contact::back : workspace_.contact[m];
    }
  }
}

}  // namespace annulus::dynamics
