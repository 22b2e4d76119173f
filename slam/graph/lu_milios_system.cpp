#include "slam/graph/lu_milios_system.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include <cholmod.h>
#include <fmt/format.h>

#include "slam/core/error.hpp"

namespace planum {
namespace {

constexpr std::size_t size = 6;
constexpr std::size_t none = static_cast<std::size_t>(-1);

}  // namespace

/// Column-wise upper triangle: block column j holds block rows i <= j.
struct LuMiliosSystem::Cholmod {
  cholmod_common common;
  cholmod_sparse* matrix = nullptr;
  cholmod_factor* factor = nullptr;
  std::vector<std::size_t> row;  ///< of each pose, in blocks; none: fixed
  std::size_t rows = 0;          ///< in blocks
  std::vector<std::size_t>
      block_at;  ///< of each block row: where its diagonal block is in its column
  std::vector<std::size_t> link_at;  ///< of each link the same for its off-diagonal block
  std::vector<std::pair<std::size_t, std::size_t>> links;

  Cholmod() {
    cholmod_start(&common);
    // Simplicial: small fronts only, and no BLAS whose sums depend on its threads.
    common.supernodal = CHOLMOD_SIMPLICIAL;
    common.final_ll = 1;
    common.print = 0;
    common.error_handler = nullptr;
  }
  ~Cholmod() {
    cholmod_free_sparse(&matrix, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;

  void number_rows(const std::vector<bool>& fixed) {
    row.assign(fixed.size(), none);
    for (std::size_t i = 0; i < fixed.size(); ++i)
      if (!fixed[i]) row[i] = rows++;
  }

  /// Lays out the blocks of each block column and the matrix of their places.
  void lay_out() {
    std::map<std::pair<std::size_t, std::size_t>, std::size_t>
        blocks;  // (column, row) -> place in it
    for (std::size_t r = 0; r < rows; ++r) blocks[{r, r}] = 0;
    for (const auto& [a, b] : links)
      if (row[a] != none && row[b] != none)
        blocks[{std::max(row[a], row[b]), std::min(row[a], row[b])}] = 0;
    std::vector<std::size_t> height(rows, 0);
    for (auto& [at, place] : blocks) place = height[at.first]++;
    block_at.resize(rows);
    for (std::size_t r = 0; r < rows; ++r) block_at[r] = blocks[{r, r}];
    link_at.assign(links.size(), none);
    for (std::size_t l = 0; l < links.size(); ++l) {
      const auto [a, b] = std::pair(row[links[l].first], row[links[l].second]);
      if (a != none && b != none) link_at[l] = blocks[{std::max(a, b), std::min(a, b)}];
    }
    allocate(blocks, height);
  }

  /// The diagonal block of a column is its last one; only its upper triangle is kept.
  void allocate(const std::map<std::pair<std::size_t, std::size_t>, std::size_t>& blocks,
                const std::vector<std::size_t>& height) {
    std::size_t entries = 0;
    for (const std::size_t h : height) entries += size * size * (h - 1) + size * (size + 1) / 2;
    matrix =
        cholmod_allocate_sparse(size * rows, size * rows, entries, 1, 1, 1, CHOLMOD_REAL, &common);
    if (!matrix) throw Error("relaxation: out of memory", ErrorKind::environment);
    int* const column_begin = static_cast<int*>(matrix->p);
    int* const row_index = static_cast<int*>(matrix->i);
    int at = 0;
    for (std::size_t column = 0; column < rows; ++column)
      for (std::size_t c = 0; c < size; ++c) {
        column_begin[size * column + c] = at;
        for (auto block = blocks.lower_bound({column, 0});
             block != blocks.end() && block->first.first == column; ++block)
          for (std::size_t r = 0; r < (block->first.second == column ? c + 1 : size); ++r)
            row_index[at++] = static_cast<int>(size * block->first.second + r);
      }
    column_begin[size * rows] = at;
  }

  /// Adds a block (row block <= column block) to the matrix.
  void add(std::size_t place, std::size_t row_block, std::size_t column_block, const Matrix6d& m) {
    double* const values = static_cast<double*>(matrix->x);
    const int* const column_begin = static_cast<const int*>(matrix->p);
    for (std::size_t c = 0; c < size; ++c) {
      double* const column = values + column_begin[size * column_block + c] +
                             static_cast<std::ptrdiff_t>(size * place);
      for (std::size_t r = 0; r < (row_block == column_block ? c + 1 : size); ++r)
        column[r] += m(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(c));
    }
  }
};

LuMiliosSystem::LuMiliosSystem(std::span<const std::pair<std::size_t, std::size_t>> links,
                               std::vector<bool> fixed)
    : cholmod_(std::make_unique<Cholmod>()) {
  for (const auto& [a, b] : links)
    if (a >= fixed.size() || b >= fixed.size() || a == b)
      throw Error(fmt::format("relaxation: a link of poses {} and {}, but there are {} poses", a, b,
                              fixed.size()));
  cholmod_->links.assign(links.begin(), links.end());
  cholmod_->number_rows(fixed);
  cholmod_->lay_out();
  if (cholmod_->rows == 0) return;
  cholmod_->factor = cholmod_analyze(cholmod_->matrix, &cholmod_->common);
  if (!cholmod_->factor) throw Error("relaxation: CHOLMOD could not analyse the system");
}

LuMiliosSystem::~LuMiliosSystem() = default;

std::vector<Vector6d> LuMiliosSystem::solve(std::span<const LinkEquation> links,
                                            const Vector6d& damping) {
  Cholmod& c = *cholmod_;
  std::vector<Vector6d> motions(c.row.size(), Vector6d::Zero());
  if (c.rows == 0) return motions;
  std::fill_n(static_cast<double*>(c.matrix->x), c.matrix->nzmax, 0.0);
  cholmod_dense* right = cholmod_zeros(size * c.rows, 1, CHOLMOD_REAL, &c.common);
  Eigen::Map<Eigen::VectorXd> b(static_cast<double*>(right->x),
                                static_cast<Eigen::Index>(size * c.rows));
  const auto segment = [&](std::size_t block) {
    return b.segment<size>(static_cast<Eigen::Index>(size * block));
  };
  for (std::size_t r = 0; r < c.rows; ++r) c.add(c.block_at[r], r, r, damping.asDiagonal());
  for (std::size_t l = 0; l < links.size(); ++l) {
    const LinkEquation& link = links[l];
    const std::size_t row_a = c.row[link.a], row_b = c.row[link.b];
    if (row_a != none) {
      c.add(c.block_at[row_a], row_a, row_a, link.information);
      segment(row_a) += link.weighted_difference;
    }
    if (row_b != none) {
      c.add(c.block_at[row_b], row_b, row_b, link.information);
      segment(row_b) -= link.weighted_difference;
    }
    if (row_a != none && row_b != none)
      c.add(c.link_at[l], std::min(row_a, row_b), std::max(row_a, row_b), -link.information);
  }
  const bool good =
      cholmod_factorize(c.matrix, c.factor, &c.common) && c.common.status == CHOLMOD_OK;
  cholmod_dense* solution = good ? cholmod_solve(CHOLMOD_A, c.factor, right, &c.common) : nullptr;
  if (solution) {
    const Eigen::Map<const Eigen::VectorXd> x(static_cast<const double*>(solution->x), b.size());
    for (std::size_t i = 0; i < motions.size(); ++i)
      if (c.row[i] != none)
        motions[i] = x.segment<size>(static_cast<Eigen::Index>(size * c.row[i]));
  }
  cholmod_free_dense(&right, &c.common);
  const bool solved = solution != nullptr;
  cholmod_free_dense(&solution, &c.common);
  if (!solved) throw Error("relaxation: the system of links is not positive definite");
  return motions;
}

}  // namespace planum
