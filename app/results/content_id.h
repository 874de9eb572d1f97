#pragma once

#include <string>

namespace annulus::app {

/// Collects the inputs a result depends on as text; their identity decides whether an older result is still good.
class ContentId {
 public:
  ContentId& add(const std::string& name, double value);  ///< all 17 digits
  ContentId& add(const std::string& name, const std::string& value);

  [[nodiscard]] const std::string& text() const { return text_; }
  /// Name-based identifier (RFC 4122 version 5, SHA-1) of annulus's version and everything added.
  [[nodiscard]] std::string id() const;

 private:
  std::string text_;
};

/// Version of annulus, as in every result.
[[nodiscard]] const char* version();

}  // namespace annulus::app
