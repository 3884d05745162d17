#include "trajectory/foreseen_vertex.hpp"

#include <isostat/linear/factorisation.hpp>
#include <isostat/rigidity/contact_pattern.hpp>

namespace isostat {

std::size_t most_negative(std::span<const double> f, const std::vector<Contact>& contacts,
                          const std::vector<unsigned char>& backbone) {
    std::size_t best = f.size();
    double smallest = 0;
    for (std::size_t l = 0; l < f.size(); ++l) {
        const double size = signed_size(contacts[l], f[l]);
        if (size < smallest && backbone[l] != 0) {
            smallest = size;
            best = l;
        }
    }
    return best;
}

template <int Dim>
ForeseenVertex<Dim> foresee(const IsostaticStructure<Dim>& from, const std::vector<int>& loaded,
                            const std::vector<double>& force, const ApproximateInverse& approximate,
                            const Load<Dim>& load, ContactId opens, const typename ArcDeparture<Dim>::Expected& end) {
    ForeseenVertex<Dim> foreseen;
    foreseen.contacts = IsostaticStructure<Dim>::exchange(from, end.end, opens, end.closes);
    if (!foreseen.contacts) {
        return foreseen;
    }
    const sparse::Matrix<double>& h = foreseen.contacts->matrix();
    foreseen.loaded = loaded;
    foreseen.backbone =
        ContactPattern(end.end, from.dofs(), foreseen.contacts->contacts(), h, foreseen.contacts->matching())
            .carrying(loaded);
    const auto structure = IsostaticStructure<Dim>::without_proof(*foreseen.contacts);
    foreseen.approximate = approximate.exchanged(foreseen.contacts->slot(), h);
    const Factorisation factorisation(structure, *foreseen.approximate);
    foreseen.force = on_dofs(load.external_force(end.end), structure.dofs());
    // One pass mostly finds out which force is most negative.
    factorisation.solve_forces_until(foreseen.force, force, [](std::span<const double>, double) { return true; });
    foreseen.passes = factorisation.passes();
    const std::size_t opens_next = most_negative(foreseen.force, structure.contacts(), foreseen.backbone);
    if (opens_next < foreseen.force.size() && structure.contacts()[opens_next].kind != ContactKind::held) {
        foreseen.opens = ContactId(opens_next);
        (void)foreseen.approximate->mechanism(static_cast<int>(opens_next)); // kept there
    }
    return foreseen;
}

template ForeseenVertex<2> foresee<2>(const IsostaticStructure<2>&, const std::vector<int>&, const std::vector<double>&,
                                      const ApproximateInverse&, const Load<2>&, ContactId,
                                      const ArcDeparture<2>::Expected&);

} // namespace isostat
