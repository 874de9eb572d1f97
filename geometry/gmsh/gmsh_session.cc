#include "geometry/gmsh/gmsh_session.h"

#include <gmsh.h>

namespace annulus::geometry {

namespace {

std::mutex& gmsh_mutex() {
  static std::mutex mutex;
  return mutex;
}

struct GmshRuntime {
  GmshRuntime() {
    // No configuration files: the user's gmsh settings must not change a mesh.
    gmsh::initialize(0, nullptr, false);
    gmsh::option::setNumber("General.Terminal", 0);
    gmsh::option::setNumber("General.NumThreads", 1);
    gmsh::option::setNumber("Mesh.MshFileVersion", 4.1);
    gmsh::option::setNumber("Mesh.SaveAll", 0);
  }
  ~GmshRuntime() {
    try {
      gmsh::finalize();
    } catch (...) {  // at process exit nobody is left to report to
    }
  }
  GmshRuntime(const GmshRuntime&) = delete;
  GmshRuntime& operator=(const GmshRuntime&) = delete;
};

/// gmsh remembers the size of the last model, and the last digits of the next mesh depend on it: a model of fixed size
/// in between makes the mesh of a gear depend on the gear alone.
void forget_last_model() {
  gmsh::model::add("unit");
  gmsh::model::geo::addLine(gmsh::model::geo::addPoint(0, 0, 0), gmsh::model::geo::addPoint(1, 1, 1));
  gmsh::model::geo::synchronize();
  gmsh::model::remove();
}

}  // namespace

GmshModel::GmshModel(const std::string& name) : lock_(gmsh_mutex()) {
  static GmshRuntime runtime;
  forget_last_model();
  gmsh::model::add(name);
}

GmshModel::~GmshModel() {
  try {
    gmsh::model::remove();
  } catch (...) {  // a destructor during unwinding: the first error is the one that counts
  }
}

}  // namespace annulus::geometry
