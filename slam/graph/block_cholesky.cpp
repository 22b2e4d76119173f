#include "slam/graph/block_cholesky.hpp"

#include <algorithm>
#include <atomic>

#include <Eigen/Cholesky>

#include "slam/core/parallel.hpp"

namespace planum {
namespace {

using Panel = Eigen::Map<Eigen::MatrixXd>;
using ConstPanel = Eigen::Map<const Eigen::MatrixXd>;

/// Multiplications of a factorization that takes some milliseconds; smaller ones are done before a
/// second thread is awake.
constexpr double worth_threads = 2e7;

Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace

void BlockMatrix::set_zero() {
  std::fill(diagonal.begin(), diagonal.end(), 0.0);
  std::fill(off_diagonal.begin(), off_diagonal.end(), 0.0);
}

BlockCholesky::BlockCholesky(std::shared_ptr<const FrontTree> tree, int block_size)
    : tree_(std::move(tree)), block_size_(block_size), updates_(tree_->fronts.size()) {
  const auto b = static_cast<std::size_t>(block_size);
  std::size_t total = 0;
  double work = 0;
  for (const Front& front : tree_->fronts) {
    panel_begin_.push_back(total);
    const std::size_t values = front.size() * front.columns * b * b;
    total += values;
    work += static_cast<double>(values) * static_cast<double>(front.size() * b);
  }
  panels_.resize(total);
  subtrees_together_ = work < worth_threads ? std::max<std::size_t>(tree_->subtrees.size(), 1) : 1;
}

BlockMatrix BlockCholesky::matrix() const {
  const auto area = static_cast<std::size_t>(block_size_ * block_size_);
  return {.block_size = block_size_,
          .diagonal = std::vector<double>(tree_->order.size() * area, 0.0),
          .off_diagonal = std::vector<double>(tree_->pairs * area, 0.0)};
}

bool BlockCholesky::factorize(const BlockMatrix& matrix) {
  std::atomic<bool> positive_definite = true;
  const auto factorize_range = [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end && positive_definite; ++f)
      if (!factorize_front(f, matrix)) positive_definite = false;
  };
  parallel_for(tree_->subtrees.size(), subtrees_together_, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s)
      factorize_range(tree_->subtrees[s].first, tree_->subtrees[s].second);
  });
  std::size_t next = 0;
  for (const auto& [begin, end] : tree_->subtrees) {
    factorize_range(next, begin);
    next = end;
  }
  factorize_range(next, tree_->fronts.size());
  return positive_definite;
}

void BlockCholesky::assemble(std::size_t f, const BlockMatrix& matrix) {
  const Front& front = tree_->fronts[f];
  const Eigen::Index b = block_size_, area = b * b;
  Panel panel(panels_.data() + panel_begin_[f], index(front.size()) * b, index(front.columns) * b);
  panel.setZero();
  for (Eigen::Index k = 0; k < front.columns; ++k) {
    const auto block = index(tree_->order[front.first_column + static_cast<std::size_t>(k)]);
    panel.block(k * b, k * b, b, b) = ConstPanel(matrix.diagonal.data() + block * area, b, b);
  }
  for (const FrontEntry& entry : front.entries) {
    const ConstPanel block(matrix.off_diagonal.data() + entry.pair * area, b, b);
    auto target = panel.block(entry.row * b, entry.column * b, b, b);
    if (entry.transposed)
      target = block.transpose();
    else
      target = block;
  }
}

/// Extend-add: the update of a child goes to the parent's columns and to the parent's own update.
template <int B>
void BlockCholesky::add_update(std::size_t child) {
  const Front& from = tree_->fronts[child];
  const auto parent = static_cast<std::size_t>(from.parent);
  const Front& to = tree_->fronts[parent];
  const std::size_t rows = from.rows.size() * B;
  double* const panel = panels_.data() + panel_begin_[parent];
  const std::size_t panel_rows = to.size() * B, update_rows = to.rows.size() * B;
  for (std::size_t j = 0; j < from.rows.size(); ++j) {
    const std::size_t column = from.in_parent[j];
    const bool in_panel = column < to.columns;
    double* const target = in_panel
                               ? panel + column * B * panel_rows
                               : updates_[parent].get() + (column - to.columns) * B * update_rows;
    const std::size_t target_rows = in_panel ? panel_rows : update_rows;
    const std::size_t first_row = in_panel ? 0 : to.columns;
    for (std::size_t c = 0; c < B; ++c) {
      const double* const source = updates_[child].get() + (j * B + c) * rows;
      double* const target_column = target + c * target_rows;
      for (std::size_t i = j; i < from.rows.size(); ++i) {
        double* const t = target_column + (from.in_parent[i] - first_row) * B;
        for (std::size_t r = 0; r < B; ++r) t[r] += source[i * B + r];
      }
    }
  }
}

bool BlockCholesky::factorize_front(std::size_t f, const BlockMatrix& matrix) {
  const Front& front = tree_->fronts[f];
  const Eigen::Index columns = index(front.columns) * block_size_;
  const Eigen::Index rows = index(front.rows.size()) * block_size_;
  assemble(f, matrix);
  if (rows > 0) {
    updates_[f] = std::make_unique_for_overwrite<double[]>(static_cast<std::size_t>(rows * rows));
    Panel(updates_[f].get(), rows, rows).setZero();
  }
  for (const std::uint32_t child : front.children) {
    switch (block_size_) {
      case 2:
        add_update<2>(child);
        break;
      case 3:
        add_update<3>(child);
        break;
      default:
        add_update<6>(child);
        break;
    }
    updates_[child].reset();
  }
  Panel panel(panels_.data() + panel_begin_[f], columns + rows, columns);
  Eigen::Ref<Eigen::MatrixXd> pivot = panel.topRows(columns);
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(pivot);
  if (factor.info() != Eigen::Success) return false;
  if (rows == 0) return true;
  auto below = panel.bottomRows(rows);
  factor.matrixL().transpose().solveInPlace<Eigen::OnTheRight>(below);
  Panel update(updates_[f].get(), rows, rows);
  update.selfadjointView<Eigen::Lower>().rankUpdate(below, -1.0);
  return true;
}

Eigen::MatrixXd BlockCholesky::solve(const Eigen::MatrixXd& right_hand_sides) const {
  const Eigen::Index b = block_size_;
  Eigen::MatrixXd x(right_hand_sides.rows(), right_hand_sides.cols()), below;
  for (std::size_t k = 0; k < tree_->order.size(); ++k)
    x.middleRows(index(k) * b, b) = right_hand_sides.middleRows(tree_->order[k] * b, b);
  const auto panel_of = [&](std::size_t f) {
    const Front& front = tree_->fronts[f];
    return ConstPanel(panels_.data() + panel_begin_[f], index(front.size()) * b,
                      index(front.columns) * b);
  };
  for (std::size_t f = 0; f < tree_->fronts.size(); ++f) {
    const Front& front = tree_->fronts[f];
    const ConstPanel panel = panel_of(f);
    auto own = x.middleRows(front.first_column * b, panel.cols());
    panel.topRows(panel.cols()).triangularView<Eigen::Lower>().solveInPlace(own);
    below.noalias() = panel.bottomRows(panel.rows() - panel.cols()) * own;
    for (std::size_t r = 0; r < front.rows.size(); ++r)
      x.middleRows(front.rows[r] * b, b) -= below.middleRows(index(r) * b, b);
  }
  for (std::size_t f = tree_->fronts.size(); f-- > 0;) {
    const Front& front = tree_->fronts[f];
    const ConstPanel panel = panel_of(f);
    auto own = x.middleRows(front.first_column * b, panel.cols());
    below.resize(panel.rows() - panel.cols(), x.cols());
    for (std::size_t r = 0; r < front.rows.size(); ++r)
      below.middleRows(index(r) * b, b) = x.middleRows(front.rows[r] * b, b);
    own.noalias() -= panel.bottomRows(below.rows()).transpose() * below;
    panel.topRows(panel.cols()).triangularView<Eigen::Lower>().transpose().solveInPlace(own);
  }
  Eigen::MatrixXd result(x.rows(), x.cols());
  for (std::size_t k = 0; k < tree_->order.size(); ++k)
    result.middleRows(tree_->order[k] * b, b) = x.middleRows(index(k) * b, b);
  return result;
}

Eigen::MatrixXd BlockCholesky::front_inverse(std::size_t f, const Eigen::MatrixXd& parent) const {
  const Front& front = tree_->fronts[f];
  const Eigen::Index b = block_size_;
  const Eigen::Index columns = index(front.columns) * b, rows = index(front.rows.size()) * b;
  const ConstPanel panel(panels_.data() + panel_begin_[f], columns + rows, columns);
  Eigen::MatrixXd inverse(columns + rows, columns + rows);
  for (std::size_t i = 0; i < front.rows.size(); ++i)
    for (std::size_t j = 0; j < front.rows.size(); ++j)
      inverse.block(columns + index(i) * b, columns + index(j) * b, b, b) =
          parent.block(front.in_parent[i] * b, front.in_parent[j] * b, b, b);
  Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(columns, columns);
  panel.topRows(columns).triangularView<Eigen::Lower>().solveInPlace(factor);  // L11^-1
  const Eigen::MatrixXd reach = panel.bottomRows(rows) * factor;               // L21 L11^-1
  auto below = inverse.bottomLeftCorner(rows, columns);
  below.noalias() = -inverse.bottomRightCorner(rows, rows) * reach;
  inverse.topRightCorner(columns, rows) = below.transpose();
  inverse.topLeftCorner(columns, columns).noalias() =
      factor.transpose() * factor - reach.transpose() * below;
  return inverse;
}

BlockMatrix BlockCholesky::inverse() const {
  const Eigen::Index b = block_size_, area = b * b;
  BlockMatrix result = matrix();
  std::vector<Eigen::MatrixXd> inverses(tree_->fronts.size());
  const Eigen::MatrixXd none;
  for (std::size_t f = tree_->fronts.size(); f-- > 0;) {
    const Front& front = tree_->fronts[f];
    const auto parent = static_cast<std::size_t>(front.parent);
    Eigen::MatrixXd inverse = front_inverse(f, front.parent < 0 ? none : inverses[parent]);
    for (Eigen::Index k = 0; k < front.columns; ++k) {
      const auto at = tree_->order[front.first_column + static_cast<std::size_t>(k)];
      Panel(result.diagonal.data() + at * area, b, b) = inverse.block(k * b, k * b, b, b);
    }
    for (const FrontEntry& entry : front.entries) {
      Panel block(result.off_diagonal.data() + entry.pair * area, b, b);
      if (entry.transposed)
        block = inverse.block(entry.column * b, entry.row * b, b, b);
      else
        block = inverse.block(entry.row * b, entry.column * b, b, b);
    }
    if (!front.children.empty()) inverses[f] = std::move(inverse);
    // Children come before their parents: with the first child all are done.
    if (front.parent >= 0 && tree_->fronts[parent].children.front() == f)
      inverses[parent].resize(0, 0);
  }
  return result;
}

}  // namespace planum
