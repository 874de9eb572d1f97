#include "app/export/export.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "app/export/fields.h"
#include "app/export/matrices.h"
#include "app/export/rexs.h"
#include "app/export/table_text.h"
#include "app/scene/overrides.h"
#include "app/scene/scene_schema.h"
#include "core/csv.h"
#include "core/errors.h"
#include "core/files.h"
#include "core/stiffness_table.h"

namespace annulus::app {

namespace {

/// A CSV without the lines in front of the column names, which many programs trip over.
void write_plain_csv(const std::filesystem::path& file, Csv csv) {
  csv.header.clear();
  csv.write(file);
}

bool has_column(const Csv& csv, const std::string& name) {
  return std::find(csv.columns.begin(), csv.columns.end(), name) != csv.columns.end();
}

/// The matrices of a ring reduced to its teeth; the stiffness is the inverse of the compliance in the file.
NamedArrays ring_matrices(const Csv& csv) {
  const auto teeth = csv.rows.size();
  if (csv.columns.size() != teeth + 1) throw InputError("is not a square matrix");
  Eigen::MatrixXd compliance(teeth, teeth);
  for (std::size_t i = 0; i < teeth; ++i)
    for (std::size_t j = 0; j < teeth; ++j) compliance(i, j) = csv.rows[i][j + 1];
  const Eigen::LLT<Eigen::MatrixXd> factor(compliance);
  if (factor.info() != Eigen::Success)
    throw InputError("the compliance is not positive definite; is the file complete?");
  const Eigen::MatrixXd stiffness =
      factor.solve(Eigen::MatrixXd::Identity(static_cast<Eigen::Index>(teeth), static_cast<Eigen::Index>(teeth)));
  NamedArrays all{csv.header, {}};
  const auto add = [&](const char* name, const Eigen::MatrixXd& m) {
    NamedArray array{name, {teeth, teeth}, {}, {}};
    for (Eigen::Index i = 0; i < m.rows(); ++i)
      for (Eigen::Index j = 0; j < m.cols(); ++j) array.values.push_back((m(i, j) + m(j, i)) / 2);
    all.arrays.push_back(std::move(array));
  };
  add("compliance_m_per_N", compliance);
  add("stiffness_N_per_m", stiffness);
  return all;
}

/// The stiffness matrix as a table: a row and a column per tooth.
Csv stiffness_csv(const Csv& compliance) {
  const auto matrices = ring_matrices(compliance);
  const auto& stiffness = matrices.arrays.back();
  const auto teeth = stiffness.shape.front();
  Csv csv;
  csv.columns = {"tooth"};
  for (std::size_t j = 0; j < teeth; ++j) csv.columns.push_back(fmt::format("stiffness_tooth_{}_N_per_m", j));
  for (std::size_t i = 0; i < teeth; ++i) {
    csv.rows.push_back({static_cast<double>(i)});
    csv.rows.back().insert(csv.rows.back().end(), stiffness.values.begin() + static_cast<long>(i * teeth),
                           stiffness.values.begin() + static_cast<long>((i + 1) * teeth));
  }
  return csv;
}

void export_table(const std::filesystem::path& source, const ExportFormat& format, const std::filesystem::path& file,
                  const ExportOptions& options) {
  const Csv csv = Csv::read(source);
  const bool plain = std::string(format.name) == "csv";
  if (has_column(csv, "stiffness_secant_N_per_m") && has_column(csv, "mesh_phase")) {
    const auto table = StiffnessTable::read_csv(source);
    if (plain) return write_plain_csv(file, csv);
    return format.write_arrays ? format.write_arrays(file, arrays_of(table))
                               : write_file(file, format.table_text(table, options));
  }
  if (!plain && !format.write_arrays)
    throw InputError(fmt::format(
        "{}: is not a stiffness table, and {} takes only stiffness tables; csv, hdf5 and matlab take any table",
        source.string(), format.name));
  const bool matrix = has_column(csv, "tooth") && has_column(csv, "compliance_tooth_0_m_per_N");
  try {
    if (plain) return write_plain_csv(file, matrix ? stiffness_csv(csv) : csv);
    format.write_arrays(file, matrix ? ring_matrices(csv) : arrays_of(csv));
  } catch (const InputError& error) {
    if (!matrix) throw;
    throw InputError(source.string() + ": " + error.what());
  }
}

template <std::string (*text)(const StiffnessTable& table)>
std::string as_text(const StiffnessTable& table, const ExportOptions& /*options*/) {
  return text(table);
}

std::string adams_statements(const StiffnessTable& table, const ExportOptions& options) {
  return adams_text(table, options.base_id.value_or(1));
}

std::vector<std::filesystem::path> write_rexs(const Scene& scene, const SceneExport& wanted) {
  write_file(wanted.file, rexs_text(scene, wanted.variant));
  return {wanted.file};
}

/// The matrices of its lumped system.
template <void (*write)(const std::filesystem::path& file, const NamedArrays& arrays)>
std::vector<std::filesystem::path> write_matrices(const Scene& scene, const SceneExport& wanted) {
  write(wanted.file, lumped_matrices(scene, wanted.variant, wanted.threads));
  return {wanted.file};
}

std::vector<std::filesystem::path> write_matrices_apart(const Scene& scene, const SceneExport& wanted) {
  return write_matrix_market(wanted.file, lumped_matrices(scene, wanted.variant, wanted.threads));
}

std::vector<std::filesystem::path> write_fields(const Scene& scene, const SceneExport& wanted) {
  return write_mesh_cycle(scene, wanted.variant, wanted.threads, wanted.file);
}

std::string formats_of_scenes() {
  std::vector<std::string> names;
  for (const auto& format : export_formats())
    if (format.write_scene) names.emplace_back(format.name);
  return listed(names);
}

}  // namespace

const std::vector<ExportFormat>& export_formats() {
  static const std::vector<ExportFormat> formats = {
      {"csv", ".plain.csv", "columns alone, for spreadsheets"},
      {"hdf5", ".h5", "HDF5 with named axes and units", nullptr, write_hdf5, write_matrices<write_hdf5>},
      {"matlab", ".mat", "MATLAB, Octave, SciPy", nullptr, write_matlab, write_matrices<write_matlab>},
      {"modelica", ".txt", "CombiTable1D and CombiTable2D of the Modelica Standard Library", as_text<modelica_text>},
      {"simpack", ".afs", "input functions of Simpack", as_text<simpack_text>},
      {"adams", ".adm", "SPLINE statements of Adams", adams_statements, nullptr, nullptr, true},
      {"rexs", ".rexs", "gear data of a scene as REXS 1.4 (XML)", nullptr, nullptr, write_rexs},
      {"mtx", ".mtx", "matrices of a scene, Matrix Market", nullptr, nullptr, write_matrices_apart},
      {"paraview", ".pvd", "deformed bodies of a scene over a mesh cycle", nullptr, nullptr, write_fields},
      {"png", ".png", "a picture of a report (OUT/pictures/*.svg) in pixels"}};
  return formats;
}

std::vector<std::filesystem::path> export_file(const std::filesystem::path& source, const std::string& format,
                                               const std::filesystem::path& out, const ExportOptions& options) {
  const auto& formats = export_formats();
  const auto found = std::find_if(formats.begin(), formats.end(), [&](const auto& f) { return f.name == format; });
  if (found == formats.end()) {
    std::vector<std::string> names;
    names.reserve(formats.size());
    for (const auto& f : formats) names.emplace_back(f.name);
    const std::string near = nearest(format, names);
    throw InputError(fmt::format("--to {}: there is no such format{}; the formats are {}", format,
                                 near.empty() ? "" : ", did you mean " + near + "?", fmt::join(names, ", ")));
  }
  if (options.base_id && !found->numbered)
    throw InputError(fmt::format("--base-id {}: {} has no numbered statements", *options.base_id, format));
  const bool is_scene = source.extension() == ".toml", is_picture = source.extension() == ".svg";
  if (is_picture != (format == "png"))
    throw InputError(
        fmt::format("{}: png takes a picture (.svg), and a picture can be exported as png only", source.string()));
  const bool takes_tables = found->table_text || found->write_arrays || format == "csv";
  if (is_scene && !found->write_scene)
    throw InputError(
        fmt::format("{}: a scene can be exported as {}; {} takes a table of a run, such as "
                    "OUT/<ring>/stiffness_ring_planet.csv",
                    source.string(), formats_of_scenes(), format));
  if (!is_scene && !is_picture && !takes_tables)
    throw InputError(fmt::format("{}: {} takes a scene (.toml)", source.string(), format));
  auto file = out;
  if (file.empty()) file = std::filesystem::path(source).replace_extension(found->ending);
  std::error_code error;
  if (std::filesystem::equivalent(file, source, error))
    throw InputError(fmt::format("-o {}: is the file to be exported itself", file.string()));
  if (is_scene) {
    const Scene scene = read_scene(source);
    const auto variants = variant_names(scene);
    SceneExport wanted{options, file};
    if (wanted.variant.empty() && variants.size() == 1) wanted.variant = variants.front();
    return found->write_scene(scene, wanted);
  }
  if (is_picture)
    write_png(source, file);
  else
    export_table(source, *found, file, options);
  return {file};
}

}  // namespace annulus::app
