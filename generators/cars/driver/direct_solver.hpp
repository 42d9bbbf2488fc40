// Sparse LU solver that keeps its ordering of the unknowns while the pattern of the matrix stays the same.
#pragma once

#include <cstring>
#include <vector>

#include "chrono/solver/ChDirectSolverLS.h"

class OrderedLU : public chrono::ChSolverSparseLU {
  private:
    bool FactorizeMatrix(bool) override {
        const int n_columns = static_cast<int>(m_mat.outerSize());
        const int n_entries = static_cast<int>(m_mat.nonZeros());
        if (!has_pattern(n_columns, n_entries)) {
            m_columns.assign(m_mat.outerIndexPtr(), m_mat.outerIndexPtr() + n_columns + 1);
            m_rows.assign(m_mat.innerIndexPtr(), m_mat.innerIndexPtr() + n_entries);
            m_lu.analyzePattern(m_mat);
        }
        m_lu.factorize(m_mat);
        return m_lu.info() == Eigen::Success;
    }

    bool SolveSystem() override {
        m_sol = m_lu.solve(m_rhs);
        return m_lu.info() == Eigen::Success;
    }

    bool has_pattern(int n_columns, int n_entries) const {
        return static_cast<int>(m_columns.size()) == n_columns + 1 &&
               static_cast<int>(m_rows.size()) == n_entries &&
               !std::memcmp(m_columns.data(), m_mat.outerIndexPtr(), sizeof(int) * (n_columns + 1)) &&
               !std::memcmp(m_rows.data(), m_mat.innerIndexPtr(), sizeof(int) * n_entries);
    }

    std::vector<int> m_columns, m_rows;
    Eigen::SparseLU<chrono::ChSparseMatrix, Eigen::COLAMDOrdering<int>> m_lu;
};
