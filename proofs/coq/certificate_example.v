(** The checker at work. Two disks, R1 = 1 and R2 = 4, in their box: centres (1, 1) and (5, 4), Lx = 9,
  Ly = 8. Contacts: disk 1 with left wall,
    bottom and disk 2, disk 2 with right wall, top and bottom;
      row of the pair: x_j - x_i instead of the unit normal. p = 2^31 - 1. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra ssrZ.
From Isostat Require Import certificate.

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

Print Assumptions two_disks_are_isostatic.
