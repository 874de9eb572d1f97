#pragma once

#include <filesystem>

#include "app/export/named_arrays.h"

/// Files of arrays. Each appears whole or not at all; both throw InputError naming the file.
namespace annulus::app {

/// HDF5: a dataset per array with its `unit`, dimensions named and attached to their axes (dimension scales); what is
/// known of the origin as attributes of the file.
void write_hdf5(const std::filesystem::path& file, const NamedArrays& arrays);

/// MATLAB, version 5 (what MATLAB, Octave and SciPy read): a variable per array, indexed in the order of its axes, and
/// a struct `provenance`.
void write_matlab(const std::filesystem::path& file, const NamedArrays& arrays);

}  // namespace annulus::app
