#pragma once

#include <functional>
#include <string>

#include "core/result_store.h"
#include "fem/problem/byte_stream.h"

namespace annulus::fem {

inline constexpr const char* superelements = "superelements";  ///< kind of these results in a store

/// Reads a superelement that depends on `inputs` from the store, or makes it and writes it there; true when it was
/// read. Without a store it is made.
bool read_or_make(const ResultStore* store, const std::string& inputs, const std::function<void(ByteReader&)>& read,
                  const std::function<void()>& make, const std::function<void(ByteWriter&)>& write);

}  // namespace annulus::fem
