#pragma once

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/model/mesh_result.h"
#include "app/model/run_options.h"
#include "core/figure.h"

/// What is measured: meshes that are solved into tables, and a lumped model that takes them.
namespace annulus::app {

/// A mesh that can be solved in several ways.
struct TradeMesh {
  MeshModel planned;
  bool needs_solid = false;
  std::string folder;  ///< of its measurements
};

/// One way to make and solve the lumped model.
struct TradeMotion {
  std::string fidelity;  ///< "harmonic balance", "time integration", "shooting", "fewer DOFs", "coupling"; empty: as a
                         ///< run finds it
  std::string settings;  ///< "64 samples per mesh cycle", "sun held in place"
  std::string id;        ///< identity of everything the figures depend on
  bool finest = false;
  bool changes_model = false;  ///< its error is not one of numbers
  /// Results of the motion, with the errors that the program states. Throws when there is no periodic motion.
  std::function<FigureSet()> figures;
};

class TradeSubject {
 public:
  TradeSubject() = default;
  TradeSubject(const TradeSubject&) = delete;
  TradeSubject& operator=(const TradeSubject&) = delete;
  virtual ~TradeSubject() = default;

  [[nodiscard]] virtual std::string name() const = 0;
  /// In the order of the tables below; none where a stiffness is given: then the motion alone is traded.
  [[nodiscard]] virtual std::vector<TradeMesh> meshes() const = 0;
  /// As a run with this wanted accuracy solves them. Throws InputError where it would.
  [[nodiscard]] virtual std::vector<MeshModel> planned(double accuracy) const = 0;
  /// The tables where there are no meshes to be traded: given, read or solved as planned.
  [[nodiscard]] virtual std::vector<MeshResult> tables_as_they_are(const RunOptions& options) const = 0;

  [[nodiscard]] virtual bool has_motion() const = 0;
  /// What these tables make of the stage, with their errors carried through.
  [[nodiscard]] virtual TradeMotion motion_on(const std::vector<MeshResult>& tables) const = 0;
  /// All ways, on the finest tables; `folder` keeps what they need besides.
  [[nodiscard]] virtual std::vector<TradeMotion> motions(const std::vector<MeshResult>& tables,
                                                         const RunOptions& options,
                                                         const std::filesystem::path& folder) const = 0;
};

}  // namespace annulus::app
