#pragma once

#include <mutex>
#include <string>

namespace annulus::geometry {

/// Exclusive use of an empty gmsh model, removed again at the end. gmsh is one process-wide object: it is started
/// quietly on first use, stays loaded until the process ends, and is locked here for the lifetime of this object.
class GmshModel {
 public:
  explicit GmshModel(const std::string& name);
  ~GmshModel();
  GmshModel(const GmshModel&) = delete;
  GmshModel& operator=(const GmshModel&) = delete;

 private:
  std::lock_guard<std::mutex> lock_;
};

}  // namespace annulus::geometry
