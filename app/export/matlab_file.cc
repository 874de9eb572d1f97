#include <fmt/format.h>
#include <matio.h>

#include <algorithm>
#include <memory>

#include "app/export/named_arrays.h"
#include "core/errors.h"
#include "core/files.h"

namespace annulus::app {

namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

Variable checked(matvar_t* variable) {
  if (variable == nullptr) throw InputError("out of memory");
  return {variable, Mat_VarFree};
}

/// The first index runs fastest there. Arrays have up to three axes.
std::vector<double> columns_first(const NamedArray& array) {
  auto shape = array.shape;
  shape.resize(3, 1);
  std::vector<double> values(array.values.size());
  auto value = array.values.begin();
  for (std::size_t i = 0; i < shape[0]; ++i)
    for (std::size_t j = 0; j < shape[1]; ++j)
      for (std::size_t k = 0; k < shape[2]; ++k) values[i + shape[0] * (j + shape[1] * k)] = *value++;
  return values;
}

Variable array_variable(const NamedArray& array) {
  auto values = columns_first(array);
  std::vector<std::size_t> shape = array.shape;
  if (shape.size() == 1) shape.push_back(1);
  return checked(Mat_VarCreate(array.name.c_str(), MAT_C_DOUBLE, MAT_T_DOUBLE, static_cast<int>(shape.size()),
                               shape.data(), values.data(), 0));
}

Variable text_variable(const std::string& name, const std::string& text) {
  std::size_t shape[2] = {text.empty() ? 0U : 1U, text.size()};
  std::string copy = text;
  return checked(Mat_VarCreate(name.c_str(), MAT_C_CHAR, MAT_T_UINT8, 2, shape, copy.data(), 0));
}

void write(mat_t* file, const Variable& variable) {
  // Octave 7 fails at compressed variables of matio.
  if (Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) != 0) throw InputError("writing failed");
}

}  // namespace

void write_matlab(const std::filesystem::path& file, const NamedArrays& arrays) {
  UnfinishedFile unfinished(file);
  try {
    const std::unique_ptr<mat_t, decltype(&Mat_Close)> out(
        Mat_CreateVer(unfinished.temporary().c_str(), "annulus", MAT_FT_MAT5), Mat_Close);
    if (!out) throw InputError("no such folder, or not writable");
    for (const auto& array : arrays.arrays) write(out.get(), array_variable(array));
    if (!arrays.provenance.empty()) {
      std::vector<std::string> keys;
      for (const auto& [key, value] : arrays.provenance) keys.push_back(key);
      std::vector<const char*> names;
      for (auto& key : keys) {
        std::replace_if(
            key.begin(), key.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
        names.push_back(key.c_str());
      }
      std::size_t shape[2] = {1, 1};
      const auto all =
          checked(Mat_VarCreateStruct("provenance", 2, shape, names.data(), static_cast<unsigned>(names.size())));
      for (std::size_t i = 0; i < keys.size(); ++i)
        Mat_VarSetStructFieldByName(all.get(), names[i], 0,
                                    text_variable(keys[i], arrays.provenance[i].second).release());
      write(out.get(), all);
    }
  } catch (const InputError& error) {
    throw FileError(fmt::format("cannot write {}: {}", file.string(), error.what()));
  }
  unfinished.finish();
}

}  // namespace annulus::app
