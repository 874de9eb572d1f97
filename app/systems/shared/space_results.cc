#include "app/systems/shared/space_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "app/sections/report_parts.h"
#include "core/units.h"
#include "dynamics/figures/motion.h"
#include "fem/face_shape.h"

namespace annulus::app {

namespace {

/// Of those that are known.
std::pair<double, double> known_range(const Eigen::Ref<const Eigen::VectorXd>& values) {
  std::pair<double, double> range{not_known, not_known};
  for (const double value : values) {
    if (std::isnan(value)) continue;
    range.first = std::isnan(range.first) ? value : std::min(range.first, value);
    range.second = std::isnan(range.second) ? value : std::max(range.second, value);
  }
  return range;
}

/// Load at the end of an even, straight face over the mean, by the place of its force.
double end_load(const SpaceResults::Mesh& mesh) { return 1 + 6 * mesh.furthest() / mesh.face_width; }

/// Of the meshes with solid faces; null: none.
const SpaceResults::Mesh* most_tilted(const SpaceResults& results) {
  const SpaceResults::Mesh* most = nullptr;
  for (const auto& mesh : results.meshes)
    if (mesh.solid_face && std::isfinite(mesh.furthest()) && (!most || end_load(mesh) > end_load(*most))) most = &mesh;
  return most;
}

/// The mesh cycle of the window in which the mean force stands furthest from the middle, as moments; none where a cycle
/// has too few samples, or in no cycle the mesh always carries.
void add_most_tilted_cycle(SpaceResults::Mesh& result, const dynamics::SpaceMotion::Mesh& mesh) {
  constexpr int fewest = 8;
  const auto cycle_of = [&](Eigen::Index i) {
    constexpr double rounding = 1e-6;  // mesh cycles
    return static_cast<int>(std::floor(std::abs(mesh.cycles[i] - mesh.cycles[0]) + rounding));
  };
  double furthest = -1;
  for (Eigen::Index first = 0, end = 0; first < mesh.force.size(); first = end) {
    for (end = first; end < mesh.force.size() && cycle_of(end) == cycle_of(first);) ++end;
    const auto force = mesh.force.segment(first, end - first).array(),
               place = mesh.place.segment(first, end - first).array();
    const double spans = std::abs(mesh.cycles[end - 1] - mesh.cycles[first]) * static_cast<double>(end - first) /
                         static_cast<double>(std::max<Eigen::Index>(1, end - first - 1));
    constexpr double whole = 0.99;
    if (end - first < fewest || spans < whole || place.isNaN().any() || force.minCoeff() <= 0) continue;
    const double from_middle = std::abs((force * place).sum() / force.sum());
    if (from_middle <= furthest) continue;
    furthest = from_middle;
    result.moments.clear();
    constexpr Eigen::Index most = 16;  // each is several contact solutions
    const Eigen::Index step = std::max<Eigen::Index>(1, (end - first) / most);
    for (Eigen::Index i = first; i < end; i += step)
      result.moments.push_back({mesh.cycles[i], mesh.force[i], mesh.tilt[i], mesh.place[i]});
  }
}

/// "sun_planet2": its load along the face, for a plot.
Series load_along(const SpaceResults::Face& face, std::size_t colour) {
  Series series{.label = face.mesh, .colour = colour};
  for (std::size_t i = 0; i < face.at.size(); ++i) {
    series.x.push_back(face.at[i] / units::mm);
    series.y.push_back(face.line_load[i] * units::mm);
  }
  return series;
}

double mean_of(const Eigen::VectorXd& values) { return values.size() == 0 ? not_known : values.mean(); }

}  // namespace

SpaceResults space_results(const dynamics::SpaceMotion& found, int cycles) {
  SpaceResults results;
  if (found.bearings.empty()) return results;
  auto& csv = results.table;
  csv.columns = {"mesh_cycle"};
  for (int c = 0; c < cycles; ++c) csv.rows.emplace_back(1, c);
  for (const auto& bearing : found.bearings) {
    const auto& name = bearing.name;
    const Eigen::VectorXd radial = bearing.force.topRows<2>().colwise().norm().transpose();
    const Eigen::VectorXd axial = bearing.force.row(2).transpose();
    const Eigen::VectorXd moment = bearing.force.bottomRows<2>().colwise().norm().transpose();
    results.bearings.push_back({name, mean_of(radial), radial.maxCoeff(), mean_of(axial), axial.cwiseAbs().maxCoeff(),
                                moment.maxCoeff(), bearing.law_deviation, bearing.table_end});
    const auto in_cycles = [&](const Eigen::VectorXd& values) { return dynamics::over_cycles(values, cycles); };
    csv.add_column(name + "_radial_max_N", in_cycles(radial).largest);
    csv.add_column(name + "_axial_mean_N", in_cycles(axial).mean);
    csv.add_column(name + "_moment_max_N_m", in_cycles(moment).largest);
  }
  for (const auto& mesh : found.meshes) {
    const Eigen::Index samples = mesh.place.size() / cycles;
    Eigen::VectorXd smallest(cycles), largest(cycles);
    for (int c = 0; c < cycles; ++c)
      std::tie(smallest[c], largest[c]) = known_range(mesh.place.segment(c * samples, samples));
    const auto [low, high] = known_range(mesh.place);
    results.meshes.push_back({mesh.name, mesh.mean_place, low, high, mesh.face_width, mesh.solid_face});
    add_most_tilted_cycle(results.meshes.back(), mesh);
    csv.add_column(mesh.name + "_place_min_m", smallest);
    csv.add_column(mesh.name + "_place_max_m", largest);
  }
  return results;
}

Warning beyond_bearing_table(const std::string& bearing, double most, double end, const std::string& ring) {
  return {"bearing_beyond_table", Severity::warning,
          fmt::format("bearing '{}' bears up to {:.3g} N radially, more than the {:.3g} N at which its table ends; the "
                      "last piece is continued there",
                      bearing, most, end),
          ring};
}

std::vector<Warning> space_result_warnings(const SpaceResults& results, double accuracy, const std::string& ring,
                                           const std::string& remedy) {
  std::vector<Warning> list;
  if (const auto* mesh = most_tilted(results); mesh && end_load(*mesh) > 1 + accuracy) {
    auto text = fmt::format(
        "gears tilt: the force of mesh '{}' stands up to {:.2g} mm from the middle of its face, which is {:.4g} mm "
        "wide. Face load factors and root stresses of this run are those of gears that do not tilt{}",
        mesh->name, mesh->furthest() / units::mm, mesh->face_width / units::mm, remedy.empty() ? "" : "; " + remedy);
    if (end_load(*mesh) > 1 + fem::reduced_face_tilt)
      text += fmt::format(". Error bars contain the change of the face up to {:.2g} mm alone",
                          fem::reduced_face_tilt * mesh->face_width / 6 / units::mm);
    const auto face = std::find_if(results.faces.begin(), results.faces.end(),
                                   [&](const auto& found) { return found.mesh == mesh->name; });
    text += face == results.faces.end()
                ? ". The load along this face is not known: back flanks carry, the mesh loses contact in every cycle, "
                  "or no "
                  "equilibrium of the gears was found"
                : fmt::format(". In this motion K_Hβ of this mesh is {}", measured(face->factor, face->error));
    list.push_back({"face_tilts", Severity::warning, std::move(text), ring});
  }
  const auto off = std::max_element(results.faces.begin(), results.faces.end(), [](const auto& a, const auto& b) {
    const auto known = [](double deviation) { return std::isnan(deviation) ? -1 : deviation; };
    return known(a.deviation) < known(b.deviation);
  });
  if (off != results.faces.end() && off->deviation > accuracy)
    list.push_back({"face_reduced", Severity::warning,
                    fmt::format("the dynamics has faces as straight about their load. At the tilt of mesh '{}' in this "
                                "motion its moment over half the face width deviates by up to {:.2g} % of the force "
                                "from that of the solid gears{}",
                                off->mesh, 100 * off->deviation, remedy.empty() ? "" : "; " + remedy),
                    ring});
  for (const auto& bearing : results.bearings)
    if (bearing.table_end > 0 && bearing.radial_max > bearing.table_end)
      list.push_back(beyond_bearing_table(bearing.name, bearing.radial_max, bearing.table_end, ring));
  const auto worst = std::max_element(results.bearings.begin(), results.bearings.end(),
                                      [](const auto& a, const auto& b) { return a.law_deviation < b.law_deviation; });
  if (worst != results.bearings.end() && worst->law_deviation > accuracy)
    list.push_back({"bearing_laws", Severity::warning,
                    fmt::format("bearings act with their stiffness at the equilibrium. In this motion the force of "
                                "bearing '{}' deviates from that of its law by {:.2g} % of the mean mesh force; "
                                "dynamics.bearing_laws = \"whole\" takes the law itself, which takes longer",
                                worst->name, 100 * worst->law_deviation),
                    ring});
  return list;
}

void add_json(Json& json, const SpaceResults& results) {
  for (const auto& b : results.bearings)
    json["bearings_in_space"][b.name] = {
        {"radial_mean_N", json_number(b.radial_mean)}, {"radial_max_N", json_number(b.radial_max)},
        {"axial_mean_N", json_number(b.axial_mean)},   {"axial_max_N", json_number(b.axial_max)},
        {"moment_max_N_m", json_number(b.moment_max)}, {"law_deviation_of_mesh_force", json_number(b.law_deviation)}};
  for (const auto& mesh : results.meshes)
    json["places_of_mesh_forces"][mesh.name] = {{"mean_m", json_number(mesh.place_mean)},
                                                {"min_m", json_number(mesh.place_min)},
                                                {"max_m", json_number(mesh.place_max)}};
  for (const auto& face : results.faces)
    json["faces_in_motion"][face.mesh] = {{"face_load_factor", json_number(face.factor)},
                                          {"face_load_factor_error", json_number(face.error)},
                                          {"deviation_of_mesh_force", json_number(face.deviation)}};
}

Blocks space_blocks(const SpaceResults& results, const std::string& of) {
  if (results.bearings.empty()) return {};
  const auto number = [](double scale, double value) { return Text(to_text(scale * value, 4)); };
  PageTable bearings{.head = {"bearings" + of, "radial force, mean, kN", "largest", "axial force, mean, kN", "largest",
                              "moment, largest, N m"}};
  for (const auto& b : results.bearings)
    bearings.rows.push_back({b.name, number(1e-3, b.radial_mean), number(1e-3, b.radial_max),
                             number(1e-3, b.axial_mean), number(1e-3, b.axial_max), number(1, b.moment_max)});
  PageTable places{.head = {"mesh force along the face" + of, "mean place, mm", "from", "to"}};
  for (const auto& mesh : results.meshes)
    places.rows.push_back(
        {mesh.name, number(1e3, mesh.place_mean), number(1e3, mesh.place_min), number(1e3, mesh.place_max)});
  Blocks loads;
  if (!results.faces.empty()) {
    PageTable factors{.head = {"load along the face" + of, "K_Hβ", "deviation of the reduced face, %"}};
    Plot plot = wide_plot("Load along the face" + of + ", mean of one mesh cycle", "from the middle, mm", "N/mm");
    for (const auto& face : results.faces) {
      factors.rows.push_back({face.mesh, measured(face.factor, face.error),
                              std::isnan(face.deviation) ? "–" : fmt::format("{:.2g}", 100 * face.deviation)});
      plot.series.push_back(load_along(face, plot.series.size()));
    }
    loads =
        Blocks(factors) +
        paragraph(
            "In the mesh cycle in which its force stands furthest from the middle. The gears carry the force and the "
            "moment of the motion. Error bars contain by how much the reduced faces of the dynamics deviate from "
            "the solid gears in this cycle, and nothing else; faces that are spread evenly have none.");
    loads += Pictures{{plot}};
  }
  return heading("Bearings and faces in space") + Blocks(bearings) +
         paragraph(
             "Without the dampers of the bearings. Forces in rigid coordinates are not known. Places count from the "
             "middle of the common face. A force that moves along the face loads the bearings at the mesh frequency "
             "even where its amount is constant (shuttling).") +
         places + loads;
}

}  // namespace annulus::app
