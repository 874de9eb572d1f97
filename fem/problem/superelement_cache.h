#pragma once

#include <functional>
#include <string>

#include "core/result_store.h"
#include "fem/problem/byte_stream.h"

namespace annulus::fem {

/// Reads `value`, which depends on `inputs` and has members() for byte streams, from the store, or has `make` fill it
/// and writes it there; true when it was read. Without a store it is made.
template <class T>
bool read_or_make(const ResultStore* store, const ByteWriter& inputs, T& value, const std::function<void()>& make) {
  if (store == nullptr) {
    make();
    return false;
  }
  return store->find_or_make(
      "superelements", inputs.bytes(), ResultStore::Packing::plain,
      [&](const std::string& content) { ByteReader{content}(value); },
      [&] {
        make();
        ByteWriter out;
        out(value);
        return out.bytes();
      });
}

}  // namespace annulus::fem
