// Counting on crystals: equal disks on an m x m square lattice have N_f = 2 m^2 + 2, N = 2 m^2 + 2 m, hence 2 m - 2
// self-stresses; the rank is that of the stored coordinates, exact.
#include <isostat/rigidity/counting.hpp>

#include <cstdio>

int main() {
    using namespace isostat;
    for (int m = 2; m <= 6; ++m) {
        Packing packing;
        std::vector<Contact> contacts;
        for (int i = 0; i < m * m; ++i) {
            const int column = i % m;
            const int row = i / m;
            packing.radius.push_back(1);
            packing.q.push_back(1 + 2 * column);
            packing.q.push_back(1 + 2 * row);
            contacts.push_back(column > 0 ? Contact{ContactKind::disk_disk, i - 1, i}
                                          : Contact{ContactKind::lower_wall, i, 0});
            contacts.push_back(row > 0 ? Contact{ContactKind::disk_disk, i - m, i}
                                       : Contact{ContactKind::lower_wall, i, 1});
            if (column + 1 == m) {
                contacts.push_back({ContactKind::upper_wall, i, 0});
            }
            if (row + 1 == m) {
                contacts.push_back({ContactKind::upper_wall, i, 1});
            }
        }
        packing.q.push_back(2 * m);
        packing.q.push_back(2 * m);
        const Counting count = count_contacts(packing, contacts);
        std::printf("%d x %d: N_f = %d, N = %d, rank %d, h = %d, k = %d\n", m, m, count.dof_count, count.contact_count,
                    count.rank, count.hyperstaticity, count.mechanisms);
        if (count.hyperstaticity != 2 * m - 2 || count.mechanisms != 0 || count.rank_exact != Verdict::proved) {
            return 1;
        }
    }
    return 0;
}
