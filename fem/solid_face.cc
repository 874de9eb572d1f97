#include "fem/solid_face.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <utility>

#include "core/errors.h"
#include "fem/body/resolution.h"
#include "fem/condensation/lapack.h"
#include "fem/contact/contact_system.h"
#include "fem/contact/imposed_contact.h"
#include "fem/levels/mesh_bodies.h"
#include "fem/problem/problem_check.h"
#include "fem/problem/solved_pair.h"

namespace annulus::fem {

namespace {

/// Elements and pairs are those of so many times the expected load: a face that carries at one end alone has it there.
constexpr double first_reach = 2;

}  // namespace

class SolidFace::Bodies {
 public:
  Bodies(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level)
      : problem_(problem),
        flanks_(solved_pair(problem.pair)),
        bodies_(build_bodies(problem_, flanks_, settings, level)),
        options_(options(settings, level)),
        system_(flanks_, *bodies_.pinion, *bodies_.wheel, nullptr, problem_.materials, bodies_.slice_edges, options_) {
    const auto& edges = bodies_.slice_edges;
    for (std::size_t s = 0; s + 1 < edges.size(); ++s)
      stations_.push_back((edges[s] + edges[s + 1]) / 2 - (edges.front() + edges.back()) / 2);
  }

  [[nodiscard]] const std::vector<double>& stations() const { return stations_; }
  [[nodiscard]] const std::vector<double>& edges() const { return bodies_.slice_edges; }
  [[nodiscard]] double normal_factor() const { return std::cos(flanks_.pair().pinion().base_helix_angle()); }
  /// `reach`: of the expected load, for elements and for the pairs that are looked for.
  [[nodiscard]] std::shared_ptr<const ToothPairs> pairs(double phase, double load, double reach) const {
    const Key key{phase, load, reach};
    const auto entry = entry_of(key);
    std::call_once(entry->once, [&] { entry->pairs = system_.pairs(phase, reach * load); });
    const std::lock_guard guard(lock_);
    const auto found = prepared_.find(key);
    if (found != prepared_.end() && found->second == entry && !entry->counted) {
      bytes_ += bytes_of(*entry->pairs);
      entry->counted = true;
    }
    return entry->pairs;
  }

  /// What `find` makes: the tangent at a phase under an expected load, which many positions of a stage ask for.
  [[nodiscard]] Eigen::MatrixXd in_contact(double phase, double load,
                                           const std::function<Eigen::MatrixXd()>& find) const {
    const auto entry = [&] {
      const std::lock_guard guard(lock_);
      auto& found = tangents_[{phase, load}];
      if (!found) found = std::make_shared<Tangent>();
      return found;
    }();
    std::call_once(entry->once, [&] { entry->value = find(); });
    return entry->value;
  }

  /// m, of the elements along the line of action, from the pitch point into the driven gear.
  [[nodiscard]] Eigen::VectorXd arms(const ToothPairs& pairs) const {
    const auto& pair = flanks_.pair();
    const double sign = pair.driver() == geometry::GearRole::pinion ? 1 : -1;
    Eigen::VectorXd arms(pairs.contacts);
    Eigen::Index at = 0;
    for (const auto& p : pairs.pairs)
      for (const auto& e : p.elements) arms[at++] = sign * ((e.roll_low + e.roll_high) / 2 - pair.roll_length_pitch());
    return arms;
  }

 private:
  using Key = std::tuple<double, double, double>;
  struct Entry {
    std::once_flag once;
    std::shared_ptr<const ToothPairs> pairs;
    bool counted = false;
  };
  struct Tangent {
    std::once_flag once;
    Eigen::MatrixXd value;  // slices and the lean, squared: small
  };
  static double bytes_of(const ToothPairs& pairs) { return 8.0 * static_cast<double>(pairs.compliance.size()); }

  /// The place of some pairs, which the first one who asks prepares. The oldest ones go where they become too large.
  [[nodiscard]] std::shared_ptr<Entry> entry_of(const Key& key) const {
    constexpr double most_bytes = 3e8;
    const std::lock_guard guard(lock_);
    if (const auto found = prepared_.find(key); found != prepared_.end()) return found->second;
    while (bytes_ > most_bytes && !order_.empty()) {
      const auto oldest = prepared_.find(order_.front());
      if (oldest->second->counted) bytes_ -= bytes_of(*oldest->second->pairs);
      prepared_.erase(oldest);
      order_.pop_front();
    }
    order_.push_back(key);
    return prepared_[key] = std::make_shared<Entry>();
  }

  [[nodiscard]] ContactOptions options(const LoadedMeshSettings& settings, int level) const {
    ContactOptions options;
    // As long as those of a table, although the window is that of more load.
    options.elements =
        static_cast<int>(std::ceil(std::sqrt(first_reach) * pressure_elements(problem_, settings, level)));
    options.gaps = {problem_.misalignment, problem_.pinion_overhang.below, problem_.wheel_overhang.below};
    return options;
  }

  LoadedMeshProblem problem_;
  FlankContact flanks_;
  MeshBodies bodies_;
  ContactOptions options_;
  ContactSystem system_;
  std::vector<double> stations_;
  mutable std::mutex lock_;
  mutable std::map<Key, std::shared_ptr<Entry>> prepared_;
  mutable std::deque<Key> order_;
  mutable std::map<std::pair<double, double>, std::shared_ptr<Tangent>> tangents_;
  mutable double bytes_ = 0;  // of the pairs that are held
};

namespace {

/// A mesh in one position. Its contacts are remembered from one approach to the next.
template <class Bodies>
class SolidFaceLaw final : public FaceLaw {
 public:
  SolidFaceLaw(const Bodies& bodies, double phase, double load) : bodies_(bodies), phase_(phase), load_(load) {
    prepare();
  }

  [[nodiscard]] int size() const override { return static_cast<int>(bodies_.stations().size()) + 1; }
  [[nodiscard]] const std::vector<double>& stations() const override { return bodies_.stations(); }
  [[nodiscard]] double face_width() const override { return bodies_.edges().back() - bodies_.edges().front(); }

  [[nodiscard]] State at(const Eigen::VectorXd& approach) const override {
    for (;;) {
      auto solution = contact_->solve(approach);
      // Elements end where nothing touches any more, and pairs that were left out stay apart.
      const double nearest = approach.head(size() - 1).maxCoeff() + farthest_arm_ * std::abs(approach[size() - 1]);
      const double allowed = bodies_.normal_factor() * (contact_->pairs().reach + least_gap_);
      if (!solution.at_window_end && nearest <= allowed)
        return {solution.energy, std::move(solution.force), std::move(solution.tangent)};
      constexpr double largest = 1e4;
      if (reach_ > largest)
        throw InputError(fmt::format(
            "mesh phase {:.4f}: flanks approach each other by {:.4g} mm: the displacements are not small; reduce the "
            "load, or make teeth, supports or material stiffer",
            phase_, 1e3 * nearest));
      reach_ *= 2;
      prepare();
    }
  }

  /// Under the expected load.
  [[nodiscard]] Eigen::MatrixXd in_contact() const override {
    return bodies_.in_contact(phase_, load_, [&] { return SolidFaceLaw(bodies_, phase_, load_).under_load(); });
  }

  [[nodiscard]] Eigen::VectorXd line_load(const Eigen::VectorXd&, const State& state) const override {
    Eigen::VectorXd load = state.force.head(size() - 1);
    for (Eigen::Index s = 0; s < load.size(); ++s) {
      const auto slice = static_cast<std::size_t>(s);
      load[s] /= bodies_.edges()[slice + 1] - bodies_.edges()[slice];
    }
    return load;
  }

 private:
  [[nodiscard]] Eigen::MatrixXd under_load() const {
    Eigen::VectorXd approach = Eigen::VectorXd::Zero(size());
    double step = 0.2 * bodies_.normal_factor() * contact_->pairs().reach / reach_;
    auto& a = approach;
    a.head(size() - 1).setConstant(bodies_.normal_factor() * least_gap_);
    for (int i = 0; i < 30; ++i) {
      a.head(size() - 1).array() += step;
      const auto state = at(a);
      if (state.force.head(size() - 1).sum() >= load_ / 2) return state.tangent;
      if (i > 6) step *= 1.5;
    }
    throw SolverError(fmt::format("mesh phase {:.4f}: no approach of the flanks gives {:.4g} N", phase_, load_));
  }

  void prepare() const {
    auto pairs = bodies_.pairs(phase_, load_, reach_);
    least_gap_ = std::numeric_limits<double>::infinity();
    for (const auto& p : pairs->pairs) least_gap_ = std::min(least_gap_, p.smallest_gap);
    auto arms = bodies_.arms(*pairs);
    farthest_arm_ = arms.cwiseAbs().maxCoeff();
    contact_ = std::make_unique<ImposedContact>(std::move(pairs), size() - 1, std::move(arms));
  }

  const Bodies& bodies_;
  double phase_, load_;
  mutable double reach_ = first_reach, least_gap_ = 0, farthest_arm_ = 0;
  mutable std::unique_ptr<ImposedContact> contact_;
};

}  // namespace

SolidFace::SolidFace(const LoadedMeshProblem& problem, const LoadedMeshSettings& settings, int level) {
  check_problem(problem, settings.fidelity);
  if (const auto why = why_no_solid_face(problem, settings.fidelity); !why.empty())
    throw InputError(fmt::format("the mesh has no contact along its face: {}", why));
  auto whole = settings;
  whole.symmetry = false;
  bodies_ = std::make_unique<Bodies>(problem, whole, level);
}

SolidFace::~SolidFace() = default;

const std::vector<double>& SolidFace::stations() const { return bodies_->stations(); }

std::shared_ptr<const FaceLaw> SolidFace::at(double mesh_cycles, double load) const {
  // Positions that differ by rounding alone are one.
  constexpr double grid = 1 << 20;
  const double phase = std::round((mesh_cycles - std::floor(mesh_cycles)) * grid) / grid;
  return std::make_shared<SolidFaceLaw<Bodies>>(*bodies_, phase >= 1 ? 0.0 : phase, load);
}

std::string why_no_solid_face(const LoadedMeshProblem& problem, Fidelity fidelity) {
  if (fidelity != Fidelity::solid) return fmt::format("its model is {}, not solid", fidelity_name(fidelity));
  if (problem.planet_rollers) return "the planets stand on rollers";
  if (problem.pair.internal() && on_single_supports(problem.structure)) return "the ring stands on single supports";
  return "";
}

}  // namespace annulus::fem
