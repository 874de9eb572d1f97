#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "app/study/study_subject.h"
#include "app/systems/helical_pair/report/pair_report_parts.h"
#include "dynamics/figures/spectrum.h"

namespace annulus::app {

namespace {

bool errors_rule_range(const ShareRow& row) {
  return row.shares.errors_alone.quasi_static > row.shares.stiffness_alone.quasi_static;
}
/// The largest error counts from where the flanks just touch: half the range of the errors on top of the deflection.
bool errors_rule_largest(const ShareRow& row) {
  return row.shares.errors_alone.quasi_static / 2 > std::abs(row.shares.load_deflection);
}

struct Conclusion {
  std::string statement, numbers, why;
  std::optional<bool> agrees{};  ///< nothing: cannot be decided
};

/// Which cause rules at all torques, at a few or at none.
struct Rule {
  bool (*holds)(const ShareRow& row);
  const std::vector<const ShareRow*>& rows;

  /// The first torque at which it does not hold.
  [[nodiscard]] auto end() const {
    return std::find_if(rows.begin(), rows.end(), [&](const auto* row) { return !holds(*row); });
  }
  [[nodiscard]] bool everywhere() const { return end() == rows.end(); }
  [[nodiscard]] std::string text() const {
    if (end() == rows.begin()) return "at none of the torques";
    const auto last = torque_text((*std::prev(end()))->pinion_torque);
    return everywhere() ? "at all torques up to " + last : "up to " + last + " only";
  }
};

void add_shares(std::vector<Conclusion>& list, const PairRunResult& result) {
  const auto rows = good_rows(result);
  if (rows.empty()) return;
  const auto &first = *rows.front(), &last = *rows.back();
  const Rule range{errors_rule_range, rows}, largest{errors_rule_largest, rows};
  const auto numbers = [&](const char* errors, double amplitude, const char* stiffness, auto value) {
    return fmt::format("{} {} µm; {} {} µm at {} to {} µm at {}", errors, um_text(amplitude), stiffness,
                       um_text(value(first)), torque_text(first.pinion_torque), um_text(value(last)),
                       torque_text(last.pinion_torque));
  };
  list.push_back(
      {"Manufacturing error is the main cause of the peak-to-peak transmission error",
       numbers("quasi-static, errors alone", first.shares.errors_alone.quasi_static, "stiffness alone",
               [](const ShareRow& row) { return row.shares.stiffness_alone.quasi_static; }),
       "Holds " + range.text() +
           ". The errors do not depend on the load. The motion by the stiffness ripple is proportional to the load.",
       range.everywhere()});
  list.push_back(
      {"Manufacturing error is the main cause of the largest transmission error; deflection under load matters little",
       numbers("amplitude of the errors", first.shares.errors_alone.quasi_static / 2, "mean deflection",
               [](const ShareRow& row) { return row.shares.load_deflection; }),
       "Holds " + largest.text() +
           (largest.everywhere()
                ? "."
                : ". At the other torques the largest transmission error is mainly deflection of teeth and bearings."),
       largest.everywhere()});
}

/// How far values over the loads stay from their straight line, relative to their range.
double off_line(const std::vector<double>& x, const std::vector<double>& y) {
  const auto about_mean = [](const std::vector<double>& v) -> Eigen::ArrayXd {
    const Eigen::Map<const Eigen::ArrayXd> values(v.data(), static_cast<Eigen::Index>(v.size()));
    return values - values.mean();
  };
  const Eigen::ArrayXd dx = about_mean(x), dy = about_mean(y);
  const double slope = (dx * dy).sum() / dx.square().sum();
  return (dy - slope * dx).abs().maxCoeff() / (dy.maxCoeff() - dy.minCoeff());
}

/// Figures 5 and 6: the rows of a grid over torque at its lowest speed.
void add_loads(std::vector<Conclusion>& list, const PairRunResult& result) {
  for (const auto& grid : result.studies.grids) {
    if (grid.grid.x.input != "stage.pinion_torque_Nm" || grid.x.size() < 3) continue;
    for (const auto& [column, words, scale, unit] :
         {std::tuple{"mesh_force_max_N", "The largest mesh force grows with the torque", 1e-3, "kN"},
          {"transmission_error_max_m", "The largest transmission error grows with the torque", 1e6, "µm"}}) {
      std::vector<double> x, y;
      for (std::size_t i = 0; i < grid.x.size(); ++i) {
        const double value = grid.variants.front()[i].value(column);
        if (std::isfinite(value)) x.push_back(grid.x[i]), y.push_back(scale * value);
      }
      if (x.size() < 3) continue;
      const bool grows = std::is_sorted(y.begin(), y.end());
      list.push_back(
          {words,
           fmt::format("{} to {} {} from {} to {}, at {} {}", to_text(y.front(), 4), to_text(y.back(), 4), unit,
                       torque_text(x.front()), torque_text(x.back()), to_text(grid.y.front(), 4), grid.y_unit),
           fmt::format("{}. The largest deviation from a straight line is {:.1f} % of the range.",
                       grows ? "It grows throughout" : "It does not grow throughout", 100 * off_line(x, y)),
           grows});
    }
    return;
  }
}

/// From which multiple of the mesh frequency on the computed transmission error is smaller than `error`, m.
int first_unknown_order(const MeshResult& mesh, double error) {
  Eigen::VectorXd lte(mesh.table.phases());
  for (int i = 0; i < mesh.table.phases(); ++i) lte[i] = mesh.table.at(0, i, static_cast<int>(mesh.nominal)).lte;
  const auto spectrum = dynamics::spectrum(lte, 1);
  int order = 1;
  while (order < spectrum.amplitude.size() && spectrum.amplitude[order] > error) ++order;
  return order;
}

Conclusion excitation(const PairRunResult& result, const SpeedRow& low, const SpeedRow& top, const SpeedRow& high) {
  const auto errors_more = [](const SpeedRow& row) {
    return row.errors_alone.acceleration > row.stiffness_alone.acceleration;
  };
  Conclusion c{
      .statement = "Stiffness is the main excitation at low speed, the errors at high speed",
      .numbers = "acceleration, errors alone and stiffness alone: ",
      .why = fmt::format("The main excitation is the {} at the lowest speed and the {} at the highest speed. ",
                         errors_more(low) ? "errors" : "stiffness", errors_more(high) ? "errors" : "stiffness"),
      .agrees = !errors_more(low) && errors_more(high) && errors_more(top)};
  for (const auto* row : {&low, &top, &high})
    c.numbers +=
        fmt::format("{}{} and {} m/s² at {}", row == &low ? "" : ", ", to_text(row->errors_alone.acceleration, 3),
                    to_text(row->stiffness_alone.acceleration, 3), speed_text(row->pinion_speed));
  c.why +=
      std::holds_alternative<dynamics::HarmonicStiffness>(result.pair->mesh)
          ? "Harmonic stiffness and error both excite at mesh frequency, so their ratio hardly depends on the speed."
          : "At low speed the higher harmonics of the stiffness have the largest effect.";
  if (!result.mesh.computed || errors_more(low)) return c;
  // What excites at low speed may be the roughness of the table.
  const auto lte = result.mesh.computed->lte_mean();
  const double error = lte.value * lte.error_relative;
  c.why += fmt::format(
      " From order {} on they are smaller than the estimated error of the table (±{} µm) and therefore not known.",
      first_unknown_order(*result.mesh.computed, error), um_text(error, 2));
  if (c.agrees == true) c.agrees = std::nullopt;
  return c;
}

void add_speeds(std::vector<Conclusion>& list, const PairRunResult& result) {
  const auto rows = good_speeds(result);
  if (rows.size() < 4) return;
  const auto &low = *rows.front(), &high = *rows.back();
  const auto top = *std::max_element(
      rows.begin(), rows.end(), [](const auto* a, const auto* b) { return a->all.acceleration < b->all.acceleration; });
  // "Steady at low speed": the lower half of the speeds changes little beside what the upper half does.
  const auto& middle = *rows[rows.size() / 2];
  for (const auto& [words, pick, unit, scale] :
       {std::tuple{"The largest acceleration stays about the same at low speed and rises at high speed",
                   &SpeedRow::Motion::acceleration, "m/s²", 1.0},
        {"The peak-to-peak mesh force stays about the same at low speed and rises at high speed",
         &SpeedRow::Motion::peak_to_peak_force, "kN", 1e-3}}) {
    const double a = low.all.*pick, b = middle.all.*pick;
    double peak = 0;
    for (const auto* row : rows) peak = std::max(peak, row->all.*pick);
    // On a linear axis a twentieth of the height looks steady, a fifth does not; between, opinions differ.
    const double change = std::abs(b - a) / peak;
    const bool rises = peak > 1.1 * b;
    std::optional<bool> agrees;
    if (!rises || change > 0.2) agrees = false;
    if (rises && change < 0.05) agrees = true;
    list.push_back(
        {words,
         fmt::format("{} at {}, {} at {}, {} {} at most", to_text(scale * a, 4), speed_text(low.pinion_speed),
                     to_text(scale * b, 4), speed_text(middle.pinion_speed), to_text(scale * peak, 4), unit),
         fmt::format(
             "Between the lowest and the middle speed it changes by {:.0f} % of its largest value; from the middle "
             "speed to the peak it {}. A change below 5 % counts as constant, a change above 20 % does not.",
             100 * change, rises ? "rises" : "does not rise"),
         agrees});
  }
  list.push_back(excitation(result, low, *top, high));
}

std::vector<Conclusion> conclusions(const PairRunResult& result) {
  std::vector<Conclusion> list;
  add_shares(list, result);
  add_loads(list, result);
  add_speeds(list, result);
  return list;
}

}  // namespace

Blocks pair_verdict(const PairRunResult& result) {
  Blocks blocks;
  if (result.response) {
    const auto& f = result.response->figures;
    const auto force = dynamics::loaded_force(f).largest;
    const auto& te = f.dynamic.transmission_error;
    blocks += paragraph(fmt::format(
        "Largest mesh force {}{}, largest acceleration of the teeth {}, transmission error {} peak to peak about a "
        "mean "
        "of {}.{}",
        measured_in_unit(force, shown_units::force),
        std::isfinite(f.dynamic_factor.value) ? fmt::format(" (dynamic factor K_V {})", measured(f.dynamic_factor, 1))
                                              : "",
        measured_in_unit(f.acceleration.tooth, shown_units::acceleration),
        measured_in_unit(te.peak_to_peak, shown_units::length), measured_in_unit(te.mean, shown_units::length),
        f.contact_loss.value > 0
            ? fmt::format(" The teeth lose contact for {:.2g} % of the time.", 100 * f.contact_loss.value)
            : std::string(" The teeth never lose contact.")));
    if (!f.steady)
      blocks += paragraph("No periodic steady state was reached; the results hold for the evaluated window only.");
  }
  const auto rows = good_rows(result);
  if (!rows.empty()) {
    blocks += paragraph(phrase(
        "Manufacturing error is the main cause of the peak-to-peak transmission error {}, and of its largest value {} "
        "({} torques from {} to {}).",
        bold(Rule{errors_rule_range, rows}.text()), bold(Rule{errors_rule_largest, rows}.text()), rows.size(),
        torque_text(rows.front()->pinion_torque), torque_text(rows.back()->pinion_torque)));
  }
  const auto all = conclusions(result);
  const auto count = [&](std::optional<bool> what) {
    return std::count_if(all.begin(), all.end(), [&](const auto& c) { return c.agrees == what; });
  };
  if (!all.empty())
    blocks += paragraph(phrase(
        "Conclusions of the paper behind this model, compared with these numbers: {} hold, {} fail, {} cannot be "
        "decided ({}).",
        count(true), count(false), count(std::nullopt), link("details", "conclusions")));
  if (!result.response) blocks += paragraph("Mesh stiffness and error law only.");
  return verdict_box(blocks);
}

Section pair_conclusions_section(const PairRunResult& result) {
  Section section{"conclusions", "The paper's conclusions"};
  const auto all = conclusions(result);
  if (all.empty()) return section;
  PageTable table{.head = {"statement", "computed", "", "reason"}};
  for (const auto& c : all)
    table.rows.push_back({c.statement, c.numbers,
                          !c.agrees   ? tag(Text::Look::undecided, "undecided")
                          : *c.agrees ? tag(Text::Look::agrees, "holds")
                                      : tag(Text::Look::disagrees, "fails"),
                          c.why});
  section.blocks = paragraph(
                       "Statements of the paper on helical pairs with manufacturing errors, compared with the numbers "
                       "of this scene.") +
                   table;
  return section;
}

}  // namespace annulus::app
