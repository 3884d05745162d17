#include "verified/precise_matrix.hpp"

namespace isostat {

template <int Dim>
std::vector<Real> precise_contact_matrix(const Packing<Dim>& packing, const IsostaticStructure<Dim>& structure,
                                         mpfr_prec_t bits) {
    const sparse::Matrix<double>& h = structure.matrix();
    std::vector<Real> entries;
    const DofMap<Dim>& dofs = structure.dofs();
    entries.reserve(h.value.size());
    std::vector<Real> d(static_cast<std::size_t>(Dim), Real(bits));
    Real length(bits);
    for (std::size_t l = 0; l < structure.contacts().size(); ++l) {
        const Contact& contact = structure.contacts()[l];
        const bool pair = contact.kind == ContactKind::disk_disk;
        if (pair) {
            mpfr_set_zero(length.get(), 1);
            for (int a = 0; a < Dim; ++a) {
                const Real from(packing.coordinate(DiskId(contact.i), a), 53);
                Real& component = d[static_cast<std::size_t>(a)];
                mpfr_set_d(component.get(), packing.coordinate(DiskId(contact.j), a), MPFR_RNDN);
                mpfr_sub(component.get(), component.get(), from.get(), MPFR_RNDN);
                mpfr_fma(length.get(), component.get(), component.get(), length.get(), MPFR_RNDN);
            }
            mpfr_sqrt(length.get(), length.get(), MPFR_RNDN);
        }
        for (int e = h.start[l]; e < h.start[l + 1]; ++e) {
            if (!pair) {
                entries.emplace_back(h.value[static_cast<std::size_t>(e)], bits); // +-1
                continue;
            }
            const int coordinate = dofs.coordinate_of(h.row[static_cast<std::size_t>(e)]);
            Real value(bits);
            mpfr_div(value.get(), d[static_cast<std::size_t>(coordinate % Dim)].get(), length.get(), MPFR_RNDN);
            if (coordinate / Dim == contact.j) {
                mpfr_neg(value.get(), value.get(), MPFR_RNDN);
            }
            entries.push_back(std::move(value));
        }
    }
    return entries;
}

template std::vector<Real> precise_contact_matrix<2>(const Packing<2>&, const IsostaticStructure<2>&, mpfr_prec_t);

} // namespace isostat
