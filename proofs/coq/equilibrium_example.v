(** The certificate of an equilibrium at work: two disks in their box, as examples/programs/equilibrium_certificate.cpp
    writes them for `isostat certify`. It is accepted; with a larger gap, another contact, forces that pull, or another
    end of the interval of the load, it is refused. No larger vertical stress opens a contact here; one that is 17 times
    smaller does. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From Isostat Require Import contact_certificate max_norm box_certificate equilibrium_certificate load_certificate.
Definition touching : seq contact := [:: Disks 0 1; Lower 1 0; Lower 1 1; Upper 0 0; Upper 0 1; Upper 1 1; Held 6].
Open Scope Z_scope.
Definition the_vertex : vertex_certificate := {|
  lies_in := Plane;
  disks := 2;
  contacts := touching;
  walls := [:: true; true; true; true];
  periodic := [:: false; false];
  stored := [:: 0x15320a05e19306; 0x903009356e6a8; 0x7921f92789eb8; 0x7921f92789eb8; 0x1b5348977be9cc; 0xf243f24f13d6e; 0x0];
  radii := [:: 0x6213e919a56c6; 0x7921f92789eb7];
  weight := 2251799813685248;
  zoom := 2 ^ 40;
  refined := [:: 0x15320a05e193065effc18837; 0x903009356e6a80000000000; 0x7921f92789eb70000000000; 0x7921f92789eb70000000000;
    0x1b5348977be9cc5effc18837; 0xf243f24f13d6e0000000000; 0x0];
  error := 20;
  distance := 1099511627796;
  ball := 25673021914704;
  stiffness := 48820428658954;
  shift := 693250346838745008789159673856;
  factor := [:: [:: (0, -0x89c3717513582); (4, 0x76edb1f50b88b)]; [:: (0, -0xbf5e4f26997de); (1, -0x143d2c11d9f5b); (2, 0xf853666321a66);
    (3, 0x143d2c11d9f5b)]; [:: (0, 0x4de0e62fe61c0); (1, 0xecd50006f998); (3, -0xecd50006f998)]; [:: (1, 0x8e9ebe32699); (3, 0xae71bb90210c2);
    (5, -0x5debce203428c)]; [:: (1, -0x6ed967e7dc860); (5, 0x935512bc0b2a4)]; [:: (1, 0x29f08fce25b5a)]; [:: (6, 0x76edb1f50b88b)]] |}.
(* The units are 2 to these powers: of lengths, of refined lengths, of forces, of infinitesimal ones, of stresses. *)
Definition exponents : seq Z := [:: -51; -91; -106; -61; -56].
Definition the_forces : force_claim := {| solution := {|
  load := [:: 0x0; 0x0; 0x0; 0x0; -0x7921f92789eb700000000000000; -0xda9a44bbdf4e600000000000000; 0x0];
  fraction := 2 ^ 84;
  quotients := [:: 0x8e4042a1d8b8b2780ede75330; 0xf243f24f13d6e000000000000; 0x1b5348977be9cc000000000000; 0xf243f24f13d6e000000000000;
    0x199f2cd7d76f90069fd0fbaf5; 0x19b955c9fe72d2ff9602f0450b; 0x0];
  slack := 524916 |};
  low := [:: 0x79ceea073350640000000000000; 0x7921f92789e1840000000000000; 0xda9a44bbdf44600000000000000; 0x7921f92789e1840000000000000;
    0xccf966bebade48000000000000; 0xcdcaae4ff38ca80000000000000; 0x0];
  high := [:: 0x79ceea0733643c0000000000000; 0x7921f92789f55c0000000000000; 0xda9a44bbdf58600000000000000; 0x7921f92789f55c0000000000000;
    0xccf966bebc19c8000000000000; 0xcdcaae4ff3a0980000000000000; 0x0] |}.
Definition the_infinitesimal_forces : force_claim := {| solution := {|
  load := [:: -0x168a4325d349c9; -0xf18a8ea0b1e8200; 0x9df4c20a8ca7500; -0x1a1187496d10db00; 0x0; 0x0; 0x0];
  fraction := 2 ^ 130;
  quotients := [:: 0x69e1016620157396773af8b; -0x4e460eec17b959b8000000000; 0x14951819bc17ae800000000000; 0x0; -0x78b2354034d517d586f4d7018;
    0x78b2354034d517d586f4d7018; 0x0];
  slack := 1563 |};
  low := [:: 0x0; 0x0; 0x0; 0x0; 0x0; 0x0; 0x0];
  high := [:: 0x0; 0x0; 0x0; 0x0; 0x0; 0x0; 0x0] |}.
Definition the_rate : force_solution := {|
  load := [:: 0x0; 0x0; 0x0; 0x0; 0x0; -0xda9a44bbdf4e6; 0x0];
  fraction := 2 ^ 140;
  quotients := [:: 0x0; 0x0; 0x1b5348977be9cc000000000000; 0x0; 0x0; 0x1b5348977be9cc000000000000; 0x0];
  slack := 1 |}.
Definition the_lower_end : load_end := {|
  opens := Some 5%nat;
  mute := [:: false; false; false; false; false; true; false];
  free := [:: false; false; false; false; false; false; false];
  near := 4222830795221625;
  far := 4222830795214103 |}.
Definition the_upper_end : load_end := {|
  opens := None;
  mute := [:: true; true; false; true; true; false; false];
  free := [:: true; true; true; false; true; false; false];
  near := 0;
  far := 0 |}.
Definition the_certificate : load_certificate := {|
  equilibrium := {|
  vertex := the_vertex;
  finite := the_forces;
  infinitesimal := the_infinitesimal_forces;
  zeros := [:: false; false; false; false; false; false; false];
  unloaded := [:: false; false; false; false; false; false; false];
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
  VertexCertificate Plane 2 cs (walls the_vertex) (periodic the_vertex) (stored the_vertex) (radii the_vertex) (weight the_vertex) (zoom the_vertex)
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
Definition a_later_end : load_end := LoadEnd (Some 2) (set_nth false (nseq 7 false) 2 true) (nseq 7 false)
  (Z.pred (stress the_certificate)) (Zneg xH).
Lemma the_later_force_vanishes_there : vanishes_between the_certificate false a_later_end 2 = true.
Proof. by vm_compute. Qed.
Lemma a_later_end_is_refused : end_check the_certificate false a_later_end = false.
Proof. by vm_compute. Qed.
Lemma ends_in_the_other_direction_are_refused : end_check the_certificate true (lower_end the_certificate)
  || end_check the_certificate false (upper_end the_certificate) = false.
Proof. by vm_compute. Qed.

Print Assumptions two_disks_are_in_equilibrium.
