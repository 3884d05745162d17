#include "verified/precise_matrix.hpp"

namespace isostat {

template <int Dim>
sparse::Matrix<Real> precise_contact_matrix(const IsostaticStructure<Dim>& structure,
                                            const std::vector<Real>& coordinate, mpfr_prec_t bits) {
    const sparse::Matrix<double>& h = structure.matrix();
    sparse::Matrix<Real> result{h.rows, h.cols, {0}, {}, {}};
    const DofMap<Dim>& dofs = structure.dofs();
    std::vector<Real> d(static_cast<std::size_t>(Dim), Real(bits));
    Real length(bits);
    for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
        const Contact& contact = structure.contacts()[l];
        if (contact.kind != ContactKind::disk_disk) { // +-1
            for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
                result.row.push_back(h.row[static_cast<std::size_t>(e)]);
                result.value.emplace_back(h.value[static_cast<std::size_t>(e)], bits);
            }
            result.start.push_back(static_cast<int>(result.row.size()));
            continue;
        }
        mpfr_set_zero(length.get(), 1);
        for (int a = 0; a < Dim; ++a) {
            const auto i = static_cast<std::size_t>(Dim * contact.i + a);
            const auto j = static_cast<std::size_t>(Dim * contact.j + a);
            Real& component = d[static_cast<std::size_t>(a)];
            mpfr_sub(component.get(), coordinate[j].get(), coordinate[i].get(), MPFR_RNDN);
            mpfr_fma(length.get(), component.get(), component.get(), length.get(), MPFR_RNDN);
        }
        mpfr_sqrt(length.get(), length.get(), MPFR_RNDN);
        for (const int grain :
             {contact.i, contact.j}) { // i < j, and degrees of freedom are in the order of coordinates
            for (int a = 0; a < Dim; ++a) {
                const Real& component = d[static_cast<std::size_t>(a)];
                const int dof = dofs.dof_of(static_cast<std::size_t>(Dim * grain + a));
                if (dof < 0) {
                    continue;
                }
                Real value(bits);
                mpfr_div(value.get(), component.get(), length.get(), MPFR_RNDN);
                if (grain == contact.j) {
                    mpfr_neg(value.get(), value.get(), MPFR_RNDN);
                }
                result.row.push_back(dof);
                result.value.push_back(std::move(value));
            }
        }
        result.start.push_back(static_cast<int>(result.row.size()));
    }
    return result;
}

template sparse::Matrix<Real> precise_contact_matrix<2>(const IsostaticStructure<2>&, const std::vector<Real>&,
                                                        mpfr_prec_t);

} // namespace isostat
