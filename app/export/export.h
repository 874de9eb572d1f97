#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// `annulus export`: results and gear data in the formats of other programs.
namespace annulus::app {

struct ExportFormat {
  const char *name, *ending, *what;
};
[[nodiscard]] const std::vector<ExportFormat>& export_formats();

/// Writes `source` in `format`; `out` empty: beside the source, with the format's ending. Returns what was written.
///
///     stiffness_<mesh>.csv       all formats but rexs
///     ring_compliance.csv        csv, hdf5, matlab: the compliance and the stiffness matrix of the ring
///     other tables of a run      csv, hdf5, matlab: a vector per column
///     a scene (.toml)            rexs; `ring` chooses one where there are several
///     a picture (.svg)           png
///
/// Throws InputError when the source is none of these or cannot be had in that format.
[[nodiscard]] std::filesystem::path export_file(const std::filesystem::path& source, const std::string& format,
                                                const std::filesystem::path& out, const std::string& ring);

}  // namespace annulus::app
