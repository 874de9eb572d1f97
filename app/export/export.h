#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/export/named_arrays.h"
#include "app/scene/scene.h"

/// `annulus export`: results and gear data in the formats of other programs.
namespace annulus::app {

/// What an export needs beside its source.
struct ExportOptions {
  std::string variant{};  ///< of a scene with several
  int threads = 1;
  std::optional<int> base_id{};  ///< of the first numbered statement; absent: 1
};
struct SceneExport : ExportOptions {
  std::filesystem::path file;
};

struct ExportFormat {
  const char *name, *ending, *what;
  /// Takes stiffness tables and nothing else.
  std::string (*table_text)(const StiffnessTable& table, const ExportOptions& options) = nullptr;
  void (*write_arrays)(const std::filesystem::path& file, const NamedArrays& arrays) = nullptr;  ///< takes any table
  /// Takes scenes; returns the files.
  std::vector<std::filesystem::path> (*write_scene)(const Scene& scene, const SceneExport& wanted) = nullptr;
  bool numbered = false;  ///< has statements with numbers, which ExportOptions::base_id begins
};
[[nodiscard]] const std::vector<ExportFormat>& export_formats();

/// Writes `source` in `format`; `out` empty: beside the source, with the format's ending. Returns what was written.
///
///     stiffness_<mesh>.csv       all formats but rexs, mtx, paraview and png
///     ring_compliance.csv        csv, hdf5, matlab: the compliance and the stiffness matrix of the ring
///     other tables of a run      csv, hdf5, matlab: a vector per column
///     a scene (.toml)            rexs; hdf5, matlab, mtx: the matrices of its lumped system; paraview: its bodies
///     a picture (.svg)           png
///
/// Throws InputError when the source is none of these or cannot be had in that format.
[[nodiscard]] std::vector<std::filesystem::path> export_file(const std::filesystem::path& source,
                                                             const std::string& format,
                                                             const std::filesystem::path& out,
                                                             const ExportOptions& options);

/// A picture in pixels. Throws InputError naming the file.
void write_png(const std::filesystem::path& svg, const std::filesystem::path& png);

}  // namespace annulus::app
