#pragma once

#include <string>
#include <utility>

#include "app/results/content_id.h"
#include "core/bytes.h"
#include "core/result_store.h"

/// Results cached as values. The files of the user's folder are written from the value, whether it was computed or
/// found: what stands there afterwards is what the inputs give, whatever happened to the files meanwhile.
namespace annulus::app {

/// Identity of inputs of any kind: of all their members.
template <class... Inputs>
[[nodiscard]] std::string identity_of(const Inputs&... inputs) {
  return ContentId().add("inputs", to_bytes(inputs...)).id();
}

/// `store` may be null.
template <class T>
[[nodiscard]] std::optional<T> find_value(const ResultStore* store, const std::string& kind, const std::string& id) {
  const auto bytes = store ? store->find(kind, id) : std::nullopt;
  if (!bytes) return std::nullopt;
  return from_bytes<T>(*bytes);
}

template <class T>
struct CachedValue {
  T value;
  bool reused = false;
};

/// The cached result of this kind, else what `make` returns, which is cached.
template <class Make>
[[nodiscard]] auto cached_value(const ResultStore* store, const std::string& kind, const std::string& id, Make make) {
  using T = decltype(make());
  if (auto found = find_value<T>(store, kind, id)) return CachedValue<T>{std::move(*found), true};
  CachedValue<T> made{make(), false};
  if (store) store->keep(kind, id, to_bytes(made.value));
  return made;
}

}  // namespace annulus::app
