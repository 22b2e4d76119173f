#include "slam/graph/elimination_order.hpp"

#include <limits>
#include <memory>

#include <cholmod.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

/// CHOLMOD's state, set to compare two orderings of a matrix of which only the pattern matters.
class Cholmod {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.nmethods = 2;
    common_.method[0].ordering = CHOLMOD_AMD;
    common_.method[1].ordering = CHOLMOD_METIS;
    common_.postorder = 1;
    common_.supernodal = CHOLMOD_SIMPLICIAL;
    common_.print = 0;
  }
  ~Cholmod() { cholmod_finish(&common_); }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  cholmod_common* common() { return &common_; }

 private:
  cholmod_common common_;
};

}  // namespace

std::vector<std::uint32_t> elimination_order(
    std::size_t rows, std::span<const std::pair<std::uint32_t, std::uint32_t>> pairs) {
  if (rows == 0) return {};
  if (rows + pairs.size() > std::numeric_limits<int>::max())
    throw Error("the graph is too large: more than 2^31 poses and edges");
  Cholmod cholmod;
  const auto free_triplet = [&](cholmod_triplet* t) { cholmod_free_triplet(&t, cholmod.common()); };
  const auto free_sparse = [&](cholmod_sparse* s) { cholmod_free_sparse(&s, cholmod.common()); };
  const auto free_factor = [&](cholmod_factor* f) { cholmod_free_factor(&f, cholmod.common()); };

  const std::unique_ptr<cholmod_triplet, decltype(free_triplet)> triplet(
      cholmod_allocate_triplet(rows, rows, rows + pairs.size(), -1, CHOLMOD_PATTERN,
                               cholmod.common()),
      free_triplet);
  if (!triplet) throw Error("out of memory", ErrorKind::environment);
  auto* const i = static_cast<int*>(triplet->i);
  auto* const j = static_cast<int*>(triplet->j);
  for (std::size_t k = 0; k < rows; ++k) i[k] = j[k] = static_cast<int>(k);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    i[rows + k] = static_cast<int>(std::max(pairs[k].first, pairs[k].second));
    j[rows + k] = static_cast<int>(std::min(pairs[k].first, pairs[k].second));
  }
  triplet->nnz = rows + pairs.size();
  const std::unique_ptr<cholmod_sparse, decltype(free_sparse)> pattern(
      cholmod_triplet_to_sparse(triplet.get(), 0, cholmod.common()), free_sparse);
  if (!pattern) throw Error("out of memory", ErrorKind::environment);
  const std::unique_ptr<cholmod_factor, decltype(free_factor)> factor(
      cholmod_analyze(pattern.get(), cholmod.common()), free_factor);
  if (!factor) throw Error("out of memory", ErrorKind::environment);
  const auto* const permutation = static_cast<const int*>(factor->Perm);
  return {permutation, permutation + rows};
}

}  // namespace planum
