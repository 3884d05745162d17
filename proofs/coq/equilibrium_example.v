(** The certificate of an equilibrium at work: two disks in their box, as examples/programs/equilibrium_certificate.cpp
    writes them for `isostat certify`. It is accepted; with a larger gap, another contact, forces that pull, or another
    end of the interval of the load, it is refused. No larger vertical stress opens a contact here; one that is 17 times
    smaller does. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate max_norm box_certificate equilibrium_certificate load_certificate.
Definition touching : seq contact := [:: Disks 0 1; Lower 1 0; Lower 1 1; Upper 0 0; Upper 0 1; Upper 1 1].
Open Scope Z_scope.
Definition the_vertex : vertex_certificate := {|
  disks := 2;
  contacts := touching;
  walls := nseq 4 true;
  stored := [:: 5965993140654854; 2536575797225128; 2130989135994552; 2130989135994552; 7691395615418828; 4261978271989102];
  radii := [:: 1725402474763974; 2130989135994551];
  weight := 2251799813685248;
  zoom := 2 ^ 40;
  refined := [:: 6559678829381869452153423927; 2788994583784205391209955328; 2343047333690340602676248576; 2343047333690340602676248576; 8456778912978345266295965751; 4686094667380681205352497152];
  error := 11;
  distance := 1099511627787;
  ball := 25673021914704;
  stiffness := 99051080468625;
  shift := 693250346838745712476601450496;
  factor := [:: [:: (0, -3366588412172254); (1, -356047438847835); (2, 4368593339947622); (3, 356047438847835)]; [:: (0, -2423560242017666); (4, 2092212239251594)]; [:: (1, -1649645634951054); (3, -1649645634951054); (5, 3073752503860239)]; [:: (0, 1370053278589376); (1, 260399572646296); (3, -260399572646296)]; [:: (1, 1275125153380951); (3, -2110579920254096)]; [:: (3, 1497330610759670)]] |}.
(* The units are 2 to these powers: of lengths, of refined lengths, of forces, of infinitesimal ones, of stresses. *)
Definition exponents : seq Z := [:: -51; -91; -106; -61; -56].
Definition the_forces : force_claim := {|
  solution := {|
  load := [:: 0; 0; 0; 0; -153553950060730161736990626676736; -277111731420474404316058960789504];
  fraction := 2 ^ 84;
  quotients := [:: 704392916941062867624711902000; 1199640234849454388570239270912; 2164935401722456283719210631168; 1199640234849454388570239270912; 126872899464821754680570788597; 2038062502257634529038639842571];
  slack := 991331 |};
  low := [:: 154410311982305821425126608994304; 153553950060718722593937105616896; 277111731420462875101012892319744; 153553950060718722593937105616896; 16239731131485783678388566753280; 260872000288965762617761675083776];
  high := [:: 154410311982328699711233651113984; 153553950060741600880044147736576; 277111731420485933531105029259264; 153553950060741600880044147736576; 16239731131508517849307533017088; 260872000288988748990259774095360] |}.
Definition the_infinitesimal_forces : force_claim := {|
  solution := {|
  load := [:: -6344470489680329; -1087805033172337152; 711370969302332672; -1878431269022391040; 0; 0];
  fraction := 2 ^ 130;
  quotients := [:: 2047996309181298952639852427; -387592416667356754457955139584; 1630705652497194317855898730496; 0; -597658263108400005032805494808; 597658263108400005032805494808];
  slack := 450575 |};
  low := [:: 0; 0; 0; 0; 0; 0];
  high := [:: 0; 0; 0; 0; 0; 0] |}.
Definition the_rate : force_solution := {|
  load := [:: 0; 0; 0; 0; 0; -3845697807709414];
  fraction := 2 ^ 140;
  quotients := [:: 0; 0; 2164935401722456283719210631168; 0; 0; 2164935401722456283719210631168];
  slack := 874660 |}.
Definition the_lower_end : load_end := {|
  opens := Some 5%nat;
  mute := [:: false; false; false; false; false; true];
  free := [:: false; false; false; false; false; false];
  near := 4222830795221625;
  far := 4222830795214103 |}.
Definition the_upper_end : load_end := {|
  opens := None;
  mute := [:: true; true; false; true; true; false];
  free := [:: true; true; true; false; true; false];
  near := 0;
  far := 0 |}.
Definition the_certificate : load_certificate := {|
  equilibrium := {|
    vertex := the_vertex;
    finite := the_forces;
    infinitesimal := the_infinitesimal_forces;
    zeros := [:: false; false; false; false; false; false];
    unloaded := [:: false; false; false; false; false; false];
    gap := 891894500187681198555791360 |};
  rate := the_rate;
  stress := 72057594037927936;
  lower_end := the_lower_end;
  upper_end := the_upper_end |}.
Close Scope Z_scope.

Lemma accepted : load_check the_certificate = true.
Proof. by vm_compute. Qed.

Theorem two_disks_are_in_equilibrium (F : archiFieldType) : complete F -> certified F the_certificate.
Proof. move=> full; exact: equilibrium_with_its_interval full accepted. Qed.

(** The same with another gap, with other contacts, under the opposite load. *)
Definition two_disks : equilibrium_certificate := equilibrium the_certificate.
Definition with_gap (g : Z) : equilibrium_certificate :=
  EquilibriumCertificate the_vertex the_forces the_infinitesimal_forces (zeros two_disks) (unloaded two_disks) g.
Definition with_contacts (cs : seq contact) : vertex_certificate :=
  VertexCertificate 2 cs (walls the_vertex) (stored the_vertex) (radii the_vertex) (weight the_vertex) (zoom the_vertex)
    (refined the_vertex) (error the_vertex) (distance the_vertex) (ball the_vertex) (stiffness the_vertex)
    (shift the_vertex) (factor the_vertex).
Definition pulling : force_claim :=
  ForceClaim (ForceSolution [seq Z.opp x | x <- load the_forces] (fraction the_forces)
      [seq Z.opp x | x <- quotients the_forces] (slack the_forces))
    [seq Z.opp x | x <- high the_forces] [seq Z.opp x | x <- low the_forces].

Lemma a_larger_gap_is_refused : equilibrium_check (with_gap (Z.double (gap two_disks))) = false.
Proof. by vm_compute. Qed.
Lemma another_contact_is_refused : vertex_check (with_contacts (Lower 0 0 :: behead touching)) = false.
Proof. by vm_compute. Qed.
Lemma a_missing_contact_is_refused : vertex_check (with_contacts (behead touching)) = false.
Proof. by vm_compute. Qed.
(** Opposite loads balance as well, with forces that pull: only their sign is wrong. *)
Lemma forces_that_pull_balance : nearly_balanced two_disks pulling = true.
Proof. by vm_compute. Qed.
Lemma forces_that_pull_are_refused : equilibrium_check (EquilibriumCertificate the_vertex pulling
  the_infinitesimal_forces (zeros two_disks) (unloaded two_disks) (gap two_disks)) = false.
Proof. by vm_compute. Qed.

(** Going down, the force of disk 1 on the lower wall would vanish as well, at the stress 0: after that of the contact
    that opens. Only that is wrong with this end. *)
Definition a_later_end : load_end := LoadEnd (Some 2) (set_nth false (nseq 6 false) 2 true) (nseq 6 false)
  (Z.pred (stress the_certificate)) (Zneg xH).
Lemma the_later_force_vanishes_there : vanishes_between the_certificate false a_later_end 2 = true.
Proof. by vm_compute. Qed.
Lemma a_later_end_is_refused : end_check the_certificate false a_later_end = false.
Proof. by vm_compute. Qed.
Lemma ends_in_the_other_direction_are_refused : end_check the_certificate true (lower_end the_certificate)
  || end_check the_certificate false (upper_end the_certificate) = false.
Proof. by vm_compute. Qed.

Print Assumptions two_disks_are_in_equilibrium.
