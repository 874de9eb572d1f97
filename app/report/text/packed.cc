#include "app/report/text/packed.h"

#include <fmt/format.h>
#include <zlib.h>

#include <boost/archive/iterators/base64_from_binary.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <vector>

#include "core/errors.h"

namespace annulus::app {

std::string packed(const std::string& text) {
  auto size = ::compressBound(text.size());
  std::vector<unsigned char> bytes(size);
  const int status = ::compress2(bytes.data(), &size, reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                                 Z_BEST_COMPRESSION);
  require(status == Z_OK, fmt::format("zlib returned the status {} for {} bytes", status, text.size()));
  bytes.resize(size);
  using namespace boost::archive::iterators;
  using Digits = base64_from_binary<transform_width<std::vector<unsigned char>::const_iterator, 6, 8>>;
  std::string digits(Digits(bytes.cbegin()), Digits(bytes.cend()));
  return digits + std::string((3 - size % 3) % 3, '=');
}

}  // namespace annulus::app
