#include <alluvium/fluid/sparse_product.h>

#include <EpetraExt_MatrixMatrix.h>
#include <Epetra_FECrsMatrix.h>

#include <map>

namespace alluvium::fluid
{
  using namespace dealii;

  namespace
  {
    void check(const int error)
    {
      AssertThrow(error >= 0, ExcMessage("A sum or product of sparse matrices failed: " + std::to_string(error) + "."));
    }
  } // namespace


  std::unique_ptr<Epetra_CrsMatrix> sparse_product(const TrilinosWrappers::SparseMatrix &C,
                                                   const Vector                         &diagonal,
                                                   const TrilinosWrappers::SparseMatrix &B)
  {
    Epetra_CrsMatrix scaled(B.trilinos_matrix());
    AssertDimension(static_cast<int>(diagonal.locally_owned_size()), scaled.NumMyRows());
    for (int k = 0; k < scaled.NumMyRows(); ++k)
      {
        int     n     = 0;
        double *value = nullptr;
        scaled.ExtractMyRowView(k, n, value);
        for (int i = 0; i < n; ++i)
          value[i] *= diagonal.local_element(k);
      }
    auto product = std::make_unique<Epetra_CrsMatrix>(Copy, C.trilinos_matrix().RowMap(), 0);
    check(EpetraExt::MatrixMatrix::Multiply(C.trilinos_matrix(), false, scaled, false, *product));
    return product;
  }


  std::unique_ptr<Epetra_CrsMatrix> normal_product(const TrilinosWrappers::SparseMatrix &B, const Vector &diagonal)
  {
    const Epetra_CrsMatrix &matrix = B.trilinos_matrix();
    AssertDimension(static_cast<int>(diagonal.locally_owned_size()), matrix.NumMyRows());
    // what this rank's rows of B contribute, by B's local columns: the rows of the result that it owns and others
    std::vector<std::map<int, double>> sum(matrix.NumMyCols());
    for (int k = 0; k < matrix.NumMyRows(); ++k)
      {
        int     n     = 0;
        double *value = nullptr;
        int    *index = nullptr;
        matrix.ExtractMyRowView(k, n, value, index);
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j)
            sum[index[i]][index[j]] += value[i] * (value[j] * diagonal.local_element(k));
      }
    using Index                 = TrilinosWrappers::types::int_type;
    auto                product = std::make_unique<Epetra_FECrsMatrix>(Copy, matrix.DomainMap(), 0);
    std::vector<Index>  columns;
    std::vector<double> values;
    for (int i = 0; i < matrix.NumMyCols(); ++i)
      {
        columns.clear();
        values.clear();
        for (const auto &[j, value] : sum[i])
          {
            columns.push_back(static_cast<Index>(matrix.GCID64(j)));
            values.push_back(value);
          }
        const Index row = static_cast<Index>(matrix.GCID64(i));
        if (!columns.empty())
          check(product->InsertGlobalValues(
            1, &row, static_cast<int>(columns.size()), columns.data(), values.data(), Epetra_FECrsMatrix::ROW_MAJOR));
      }
    check(product->GlobalAssemble(matrix.DomainMap(), matrix.DomainMap()));
    return product;
  }


  std::unique_ptr<Epetra_CrsMatrix> sparse_sum(const Epetra_CrsMatrix &a, const Epetra_CrsMatrix &b)
  {
    Epetra_CrsMatrix                 *sum   = nullptr;
    const int                         error = EpetraExt::MatrixMatrix::Add(a, false, 1., b, false, 1., sum);
    std::unique_ptr<Epetra_CrsMatrix> result(sum);
    check(error);
    result->FillComplete(a.DomainMap(), a.RangeMap());
    return result;
  }
} // namespace alluvium::fluid
