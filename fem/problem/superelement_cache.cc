#include "fem/problem/superelement_cache.h"

#include <sstream>

namespace annulus::fem {

bool read_or_make(const ResultStore* store, const std::string& inputs, const std::function<void(ByteReader&)>& read,
                  const std::function<void()>& make, const std::function<void(ByteWriter&)>& write) {
  if (store == nullptr) {
    make();
    return false;
  }
  return store->find_or_make(
      superelements, inputs, ResultStore::Packing::plain,
      [&](const std::string& content) {
        std::istringstream in(content);
        ByteReader reader(in, content.size());
        read(reader);
      },
      [&] {
        make();
        std::ostringstream out;
        ByteWriter writer(out);
        write(writer);
        return out.str();
      });
}

}  // namespace annulus::fem
