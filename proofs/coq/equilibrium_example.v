(** The certificate of an equilibrium at work: two disks in their box, as examples/programs/equilibrium_certificate.cpp
    writes them for `isostat certify`. It is accepted; with a larger gap, another contact, or forces that pull,
    it is refused. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate max_norm box_certificate equilibrium_certificate.
Definition touching : seq contact := [:: Disks 0 1; Lower 1 0; Lower 1 1; Upper 0 0; Upper 0 1; Upper 1 1].
Open Scope Z_scope.
(* The units are 2 to these powers: of stored lengths, of refined ones, of forces, of infinitesimal ones. *)
Definition exponents : seq Z := [:: -51; -91; -55; -61].
Definition the_vertex : vertex_certificate := {|
  disks := 2;
  contacts := touching;
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
  factor := [:: [:: (0, -3366588412172254); (1, -2423560242017666); (3, 1370053278589376)]; [:: (0, -356047438847835); (2, -1649645634951054); (3, 260399572646296); (4, 1275125153380951)]; [:: (0, 4368593339947622)]; [:: (0, 356047438847835); (2, -1649645634951054); (3, -260399572646296); (4, -2110579920254096); (5, 1497330610759670)]; [:: (1, 2092212239251594)]; [:: (2, 3073752503860239)]] |}.
Definition the_forces : force_claim := {|
  load := [:: 0; 0; 0; 0; -68191652351825632; -123062329846701248];
  low := [:: 68571953440923848; 68191652351820552; 123062329846696128; 68191652351820552; 7211889366358985; 115850440480332112];
  high := [:: 68571953440934008; 68191652351830712; 123062329846706368; 68191652351830712; 7211889366369081; 115850440480342320];
  fraction := 2 ^ 135;
  quotients := [:: 704392916941062867624711902000; 1199640234849454388570239270912; 2164935401722456283719210631168; 1199640234849454388570239270912; 126872899464821754680570788597; 2038062502257634529038639842571];
  slack := 991331 |}.
Definition the_infinitesimal_forces : force_claim := {|
  load := [:: -6344470489680329; -1087805033172337152; 711370969302332672; -1878431269022391040; 0; 0];
  low := [:: 0; 0; 0; 0; 0; 0];
  high := [:: 0; 0; 0; 0; 0; 0];
  fraction := 2 ^ 130;
  quotients := [:: 2047996309181298952639852427; -387592416667356754457955139584; 1630705652497194317855898730496; 0; -597658263108400005032805494808; 597658263108400005032805494808];
  slack := 450575 |}.
Definition the_certificate : equilibrium_certificate := {|
  vertex := the_vertex;
  finite := the_forces;
  infinitesimal := the_infinitesimal_forces;
  zeros := [:: false; false; false; false; false; false];
  unloaded := [:: false; false; false; false; false; false];
  gap := 891894500187681198555791360 |}.
Close Scope Z_scope.

Lemma accepted : equilibrium_check the_certificate = true.
Proof. by vm_compute. Qed.

Theorem two_disks_are_in_equilibrium (F : archiFieldType) : complete F -> certified_equilibrium F the_certificate.
Proof. exact: one_equilibrium accepted. Qed.

(** The same with another gap, with other contacts, under the opposite load. *)
Definition with_gap (g : Z) : equilibrium_certificate :=
  EquilibriumCertificate the_vertex the_forces the_infinitesimal_forces (zeros the_certificate) (unloaded the_certificate) g.
Definition with_contacts (cs : seq contact) : vertex_certificate :=
  VertexCertificate 2 cs (stored the_vertex) (radii the_vertex) (weight the_vertex) (zoom the_vertex)
    (refined the_vertex) (error the_vertex) (distance the_vertex) (ball the_vertex) (stiffness the_vertex)
    (shift the_vertex) (factor the_vertex).
Definition pulling : force_claim :=
  ForceClaim [seq Z.opp x | x <- load the_forces] [seq Z.opp x | x <- high the_forces]
    [seq Z.opp x | x <- low the_forces] (fraction the_forces) [seq Z.opp x | x <- quotients the_forces] (slack the_forces).

Lemma a_larger_gap_is_refused : equilibrium_check (with_gap (Z.double (gap the_certificate))) = false.
Proof. by vm_compute. Qed.
Lemma another_contact_is_refused : vertex_check (with_contacts (Lower 0 0 :: behead touching)) = false.
Proof. by vm_compute. Qed.
Lemma a_missing_contact_is_refused : vertex_check (with_contacts (behead touching)) = false.
Proof. by vm_compute. Qed.
(** Opposite loads balance as well, with forces that pull: only their sign is wrong. *)
Lemma forces_that_pull_balance : nearly_balanced the_certificate pulling = true.
Proof. by vm_compute. Qed.
Lemma forces_that_pull_are_refused : equilibrium_check (EquilibriumCertificate the_vertex pulling
  the_infinitesimal_forces (zeros the_certificate) (unloaded the_certificate) (gap the_certificate)) = false.
Proof. by vm_compute. Qed.

Print Assumptions two_disks_are_in_equilibrium.
