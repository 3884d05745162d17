// Enclosed self-stresses and motions against the exact ones, and for lattices that have no exact bases.

#include "crafted/enclosed_bases.hpp"
#include "crafted/examples.hpp"
#include "support/exact_lattices.hpp"

namespace {

using namespace isostat::crafted;
using isostat::Verdict;

/// The vector of the span of `basis` that is 1 at free[which] and 0 at the other free components, by elimination in
/// the field. Empty when the free components do not fix it.
std::vector<Number> exact_vector(std::vector<std::vector<Number>> basis, const std::vector<int>& free,
                                 std::size_t which) {
    for (std::size_t k = 0; k < free.size(); ++k) {
        const auto column = static_cast<std::size_t>(free[k]);
        std::size_t pivot = k;
        while (pivot < basis.size() && basis[pivot][column].is_zero()) {
            ++pivot;
        }
        if (pivot == basis.size()) {
            return {};
        }
        std::swap(basis[k], basis[pivot]);
        const Number scale = basis[k][column].inverse();
        for (Number& x : basis[k]) {
            x *= scale;
        }
        for (std::size_t r = 0; r < basis.size(); ++r) {
            const Number factor = basis[r][column];
            for (std::size_t c = 0; r != k && !factor.is_zero() && c < basis[r].size(); ++c) {
                basis[r][c] -= factor * basis[k][c];
            }
        }
    }
    return basis[which];
}

int check(const std::vector<EnclosedVector>& vectors, const std::vector<std::vector<Number>>& basis,
          const std::vector<int>& free) {
    BOOST_REQUIRE_EQUAL(free.size(), basis.size());
    for (std::size_t k = 0; k < vectors.size(); ++k) {
        const std::vector<Number> exact = exact_vector(basis, free, k);
        BOOST_REQUIRE_EQUAL(exact.size(), vectors[k].value.size());
        BOOST_TEST(vectors[k].free == free[k]);
        BOOST_TEST(vectors[k].radius < 1e-6);
        const Number radius = Number::from_double(vectors[k].radius);
        for (std::size_t c = 0; c < exact.size(); ++c) {
            const Number error = exact[c] - Number::from_double(vectors[k].value[c]);
            BOOST_TEST((error <= radius && -error <= radius));
        }
    }
    return static_cast<int>(vectors.size());
}

} // namespace

BOOST_AUTO_TEST_CASE(enclosures_contain_the_exact_vectors_of_the_examples) {
    int stresses = 0, motions = 0;
    for (const auto& path : examples::packing_files()) {
        const PackingFile file = read_packing(path);
        const auto inspection = required(inspect(file.packing));
        const EnclosedBases bases = enclose_bases(file.packing, inspection, 1000);
        if (bases.verdict != Verdict::proved || inspection.bases_exact != Verdict::proved) {
            BOOST_TEST_MESSAGE(path << ": no enclosure");
            continue;
        }
        BOOST_TEST_INFO_SCOPE(path);
        stresses += check(bases.self_stresses, inspection.self_stresses, bases.free_contacts);
        motions += check(bases.motions, inspection.motions, bases.free_dofs);
    }
    BOOST_TEST(stresses > 50);
    BOOST_TEST(motions > 20);
}

BOOST_AUTO_TEST_CASE(a_lattice_without_exact_bases_gets_enclosures) {
    const ExactPacking packing = families::triangular_lattice(15, 15);
    const auto inspection = required(inspect(packing));
    BOOST_TEST((inspection.bases_exact == Verdict::undecided));
    BOOST_TEST((inspection.rank_exact == Verdict::proved));
    const EnclosedBases bases = enclose_bases(packing, inspection, 5);
    BOOST_REQUIRE((bases.verdict == Verdict::proved));
    BOOST_TEST(static_cast<int>(bases.free_contacts.size()) == inspection.hyperstaticity);
    BOOST_REQUIRE_EQUAL(bases.self_stresses.size(), 5U);
    for (const EnclosedVector& vector : bases.self_stresses) {
        BOOST_TEST(vector.radius < 1e-6);
    }
}
