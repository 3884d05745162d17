// Which disks touch? Three crafted disks in a box: every pair that could come into contact, from the regular
// triangulation, with its gap.
#include <isostat/contact/candidates.hpp>

#include <cmath>
#include <cstdio>

int main() {
    using namespace isostat;
    Packing<2> packing; // the paper's box: left and bottom fixed, right and top movable
    packing.radius = {1.0, 1.0, 0.75};
    const double height = std::sqrt(1.75 * 1.75 - 1.0); // disk 2 rests on both others
    packing.q = {1.0, 1.0, 3.0, 1.0, 2.0, 1.0 + height, /* Lx */ 4.0, /* Ly */ 1.75 + height};
    validate(packing, "crafted");
    snap_to_grid(packing);

    const double touching =
        1e-12; // only for this print-out: contacts of a vertex are part of it, never found from a threshold
    int contacts = 0;
    for (const Contact& candidate : find_candidates(packing, 0.8).contacts) {
        const double distance = gap(packing, candidate);
        const bool touches = distance < touching;
        contacts += touches ? 1 : 0;
        std::printf("%-10s gap %10.3e%s\n", to_string<2>(candidate).c_str(), distance, touches ? "  contact" : "");
    }
    const Admissibility overlap = certify_admissible(packing, touching);
    std::printf("no overlap beyond %g: %s\n", touching, std::string(to_string(overlap.verdict)).c_str());
    return contacts == 8 && overlap.verdict == Verdict::proved ? 0 : 1;
}
