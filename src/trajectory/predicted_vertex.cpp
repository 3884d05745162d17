#include "trajectory/predicted_vertex.hpp"

#include "linear/factorisation.hpp"
#include "rigidity/contact_pattern.hpp"

namespace isostat {

std::size_t most_negative(std::span<const double> f, const std::vector<Contact>& contacts,
                          const std::vector<unsigned char>& backbone, bool inside) {
    std::size_t best = f.size();
    double smallest = 0;
    for (std::size_t l = 0; l < f.size(); ++l) {
        const double size = signed_size(contacts[l], f[l]);
        if (size < smallest && (backbone[l] != 0) == inside) {
            smallest = size;
            best = l;
        }
    }
    return best;
}

PredictedVertex predict(const IsostaticStructure& from, const std::vector<int>& loaded,
                        const std::vector<double>& force, const ApproximateInverse& approximate, const Load& load,
                        ContactId opens, const ArcDeparture::Expected& end) {
    PredictedVertex predicted;
    predicted.contacts = IsostaticStructure::exchange(from, end.end, opens, end.closes);
    if (!predicted.contacts) {
        return predicted;
    }
    const sparse::Matrix<double>& h = predicted.contacts->matrix();
    predicted.loaded = loaded;
    predicted.backbone =
        ContactPattern(end.end, from.dofs(), predicted.contacts->contacts(), h, predicted.contacts->matching())
            .carrying(loaded);
    const auto structure = IsostaticStructure::without_proof(*predicted.contacts);
    const Factorisation factorisation(structure, approximate.exchanged(predicted.contacts->slot(), h));
    predicted.force = on_dofs(load.external_force(end.end), structure.dofs());
    // One pass mostly decides which force is most negative.
    factorisation.solve_forces_until(predicted.force, force, [](std::span<const double>, double) { return true; });
    predicted.passes = factorisation.passes();
    const std::size_t opens_next = most_negative(predicted.force, structure.contacts(), predicted.backbone);
    if (opens_next < predicted.force.size() && structure.contacts()[opens_next].kind != ContactKind::held) {
        predicted.opens = ContactId(opens_next);
    }
    return predicted;
}

} // namespace isostat
