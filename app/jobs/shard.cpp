#include "app/jobs/shard.hpp"

namespace joulepath {

std::string Shard::text() const {
  return is_whole() ? "" : std::to_string(number) + "/" + std::to_string(of);
}

std::vector<std::size_t> Shard::indices(std::size_t jobs) const {
  std::vector<std::size_t> indices;
  for (std::size_t k = number - 1; k < jobs; k += of) indices.push_back(k);
  return indices;
}

}  // namespace joulepath
