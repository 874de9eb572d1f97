#pragma once

#include <string>
#include <utility>
#include <vector>

#include "app/scene/scene_schema.h"

namespace annulus::random {

/// A scene as tables of written keys, before it is a file. Every [[table]] has one entry.
class SceneDraft {
 public:
  /// nullptr when the key, as "ring.pins", is not written.
  [[nodiscard]] const app::Value* find(const std::string& key) const;
  [[nodiscard]] bool has_table(const std::string& path) const;
  void open_table(const std::string& path);
  void set(const std::string& key, app::Value value);
  void remove(const std::string& key);
  void remove_table(const std::string& path);

  /// Of a written key; throws std::logic_error for one that is not, or is no number.
  [[nodiscard]] double number(const std::string& key) const;
  [[nodiscard]] std::string text_of(const std::string& key) const;  ///< empty: not written
  /// Multiplies a written number, or every one of a list; a key that is not written stays so.
  void scale(const std::string& key, double factor);

  /// The keys of the present tables as conditions of the schema see them: written values and defaults.
  [[nodiscard]] std::vector<app::Input> inputs(const std::vector<app::Table>& tables) const;
  /// The file, its tables in the order of the schema.
  [[nodiscard]] std::string toml(const std::vector<app::Table>& tables) const;

 private:
  struct DraftTable {
    std::string path;
    std::vector<std::pair<std::string, app::Value>> values;
  };
  [[nodiscard]] DraftTable* table(const std::string& path);
  [[nodiscard]] const DraftTable* table(const std::string& path) const;

  std::vector<DraftTable> tables_;
};

}  // namespace annulus::random
