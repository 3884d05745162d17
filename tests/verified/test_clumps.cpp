// Enclosures of vertices with bars against the vertex to 200 digits.
#include "oracle/truth.hpp"
#include "support/clumps.hpp"
#include "support/regular.hpp"
#include "verified/configuration.hpp"

#include <isostat/certificate/certify.hpp>

using namespace isostat;
using isostat::oracle::Real;

BOOST_AUTO_TEST_CASE(vertices_with_bars_lie_within_their_enclosures) {
    for (const char* const name : {"dimer_20_1", "dimer2_20_2", "trimer_20_1"}) {
        const State state = isostat::with_free_motions_held(isostat::test::clumps(name));
        const crafted::Regular at(state);
        const isostat::oracle::Truth truth(state);
        BOOST_TEST_REQUIRE(truth.known);
        for (const int way : {0, 1, 2}) {
            const VertexEnclosure vertex =
                way == 2   ? enclose_vertex_double_double(state.packing, at.structure, at.factorisation, at.inverse)
                : way == 1 ? enclose_vertex(state.packing, at.structure, at.factorisation, at.inverse)
                           : enclose_vertex(state.packing, at.structure, at.inverse);
            BOOST_TEST_CONTEXT(name << ", way " << way) {
                BOOST_TEST_REQUIRE((vertex.verdict == Verdict::proved));
                Real square = 0;
                for (std::size_t k = 0; k < state.packing.q.size(); ++k) {
                    const Real place =
                        Real(state.packing.q[k]) + (vertex.correction.empty() ? Real(0) : Real(vertex.correction[k]));
                    square += (place - truth.q[k]) * (place - truth.q[k]);
                }
                BOOST_TEST(sqrt(square) <= Real(vertex.radius));
                BOOST_TEST(vertex.radius < (way == 2 ? 1e-20 : 1e-9));
            }
        }
    }
}
