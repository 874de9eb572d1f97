#include <fmt/format.h>
#include <hdf5.h>
#include <hdf5_hl.h>

#include <set>

#include "app/export/named_arrays.h"
#include "core/errors.h"
#include "core/files.h"

namespace annulus::app {

namespace {

/// An identifier of the library, closed with it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) throw InputError("HDF5 refused");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  [[nodiscard]] hid_t id() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status) {
  if (status < 0) throw InputError("HDF5 refused");
}

void write_arrays(const std::filesystem::path& file, const NamedArrays& all) {
  const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  for (const auto& [key, value] : all.provenance)
    check(H5LTset_attribute_string(out.id(), "/", key.c_str(), value.c_str()));
  if (!all.scene.empty()) check(H5LTmake_dataset_string(out.id(), "scene", all.scene.c_str()));
  std::set<std::string> axes;
  for (const auto& array : all.arrays) axes.insert(array.axes.begin(), array.axes.end());
  for (const auto& array : all.arrays) {
    const std::vector<hsize_t> shape(array.shape.begin(), array.shape.end());
    check(H5LTmake_dataset_double(out.id(), array.name.c_str(), static_cast<int>(shape.size()), shape.data(),
                                  array.values.data()));
    if (const auto unit = unit_of_name(array.name); !unit.empty())
      check(H5LTset_attribute_string(out.id(), array.name.c_str(), "units", unit.c_str()));
    if (axes.count(array.name) == 0) continue;
    const Handle scale(H5Dopen2(out.id(), array.name.c_str(), H5P_DEFAULT), H5Dclose);
    check(H5DSset_scale(scale.id(), array.name.c_str()));
  }
  for (const auto& array : all.arrays) {
    if (array.axes.empty()) continue;
    const Handle data(H5Dopen2(out.id(), array.name.c_str(), H5P_DEFAULT), H5Dclose);
    for (std::size_t i = 0; i < array.axes.size(); ++i) {
      const Handle scale(H5Dopen2(out.id(), array.axes[i].c_str(), H5P_DEFAULT), H5Dclose);
      check(H5DSattach_scale(data.id(), scale.id(), static_cast<unsigned>(i)));
      check(H5DSset_label(data.id(), static_cast<unsigned>(i), array.axes[i].c_str()));
    }
  }
}

}  // namespace

void write_hdf5(const std::filesystem::path& file, const NamedArrays& arrays) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // reported once, by the exception
  UnfinishedFile unfinished(file);
  try {
    write_arrays(unfinished.temporary(), arrays);
  } catch (const InputError& error) {
    throw FileError(fmt::format("cannot write {}: {}; check that its folder exists, is writable and not full",
                                file.string(), error.what()));
  }
  unfinished.finish();
}

}  // namespace annulus::app
