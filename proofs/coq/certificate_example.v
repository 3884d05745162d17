(** The checker at work. Two disks, R1 = 1 and R2 = 4, in their box: centres (1, 1) and (5, 4), Lx = 9,
  Ly = 8. Contacts: disk 1 with left wall,
    bottom and disk 2, disk 2 with right wall, top and bottom;
      row of the pair: x_j - x_i instead of the unit normal. p = 2^31 - 1. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra ssrZ.
From Isostat Require Import certificate contact_certificate.

Definition p : Z := Eval vm_compute in (Z.pred (Z.pow (Zpos 2) (Zpos 31))).
Open Scope Z_scope.
Definition two_disks : table :=
  [:: [:: (-1); 0; 0; 0; 0; 0]
  ; [:: 0; (-1); 0; 0; 0; 0]
  ; [:: 4; 3; (-4); (-3); 0; 0]
  ; [:: 0; 0; 1; 0; (-1); 0]
  ; [:: 0; 0; 0; 1; 0; (-1)]
  ; [:: 0; 0; 0; (-1); 0; 0]].
Definition columns_of_inverse : table :=
  [:: [:: 2147483646; 0; 2147483646; 0; 2147483646; 0]
  ; [:: 0; 2147483646; 536870911; 0; 536870911; 0]
  ; [:: 0; 0; 1610612735; 0; 1610612735; 0]
  ; [:: 0; 0; 0; 0; 2147483646; 0]
  ; [:: 0; 0; 0; 0; 0; 2147483646]
  ; [:: 0; 0; 1610612736; 2147483646; 1610612736; 2147483646]].
Definition one_digit_wrong : table :=
  [:: [:: 2147483646; 0; 2147483646; 0; 2147483646; 0]
  ; [:: 0; 2147483646; 536870911; 0; 536870911; 0]
  ; [:: 0; 0; 1610612736; 0; 1610612735; 0]
  ; [:: 0; 0; 0; 0; 2147483646; 0]
  ; [:: 0; 0; 0; 0; 0; 2147483646]
  ; [:: 0; 0; 1610612736; 2147483646; 1610612736; 2147483646]].
Close Scope Z_scope.

Lemma accepted : check 6 p two_disks columns_of_inverse = true.
Proof. by vm_compute. Qed.

(** The checker can refuse. *)
Lemma refused : check 6 p two_disks one_digit_wrong = false.
Proof. by vm_compute. Qed.

Theorem two_disks_are_isostatic :
  \rank (map_mx (fun z => (int_of_Z z)%:~R%R : rat) (of_rows 6 two_disks)) = 6.
Proof. exact: check_proves_full_rank accepted. Qed.

(** Well-formed contacts are a condition of its own: one disk (1, 1) in a box 4 x 5, and its "contact" with the
  coordinates of the walls, taken for a disk. The rows are regular, the inverse is right, and the certificate is
  refused. *)
Open Scope Z_scope.
Definition one_disk : seq Z := [:: 1; 1; 4; 5].
Definition inverse_with_walls : table :=
  [:: [:: -1; 0; 0; 0]
  ; [:: 0; -1; 0; 0]
  ; [:: -1; 0; 0; -1]
  ; [:: 0; -1; 1610612735; 1610612736]].
Close Scope Z_scope.
Definition walls_as_a_disk : seq contact := [:: Lower 0 0; Lower 0 1; Disks 0 1; Upper 0 0].

Lemma its_inverse_is_right : all (fun lc => unit_row 1 p lc.1 (combination 1 inverse_with_walls (sparse_row 1 one_disk
  lc.2))) (zip (iota 0 4) walls_as_a_disk).
Proof. by vm_compute. Qed.
Lemma walls_are_no_disk : certified 1 one_disk walls_as_a_disk p inverse_with_walls = false.
Proof. by vm_compute. Qed.

Print Assumptions two_disks_are_isostatic.
