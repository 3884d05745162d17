(** Certificates that the program writes for a packing in the box: the contact matrix of the stored coordinates is
  regular
    (statement T4, ../rank_mod_p.md).

    Data: the coordinates x_0 y_0 x_1 y_1 ... Lx Ly as integer multiples of one dyadic unit, the contacts,
      a modulus p > 1 and the rows of a
    matrix B. The contact matrix A is built *here* from coordinates and contacts;
      the check is that A B = 1 modulo p. A is kept sparse, so
    that the check costs about four products of rows of B per contact. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify.
From Isostat Require Import certificate rank_morphism statics.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

(** Disks of the plane, spheres of space: the number of axes. *)
Inductive dimension := Plane | Space.
Coercion axes (d : dimension) : nat := if d is Plane then 2 else 3.

(** Grains and axes are numbered from 0. [Image i j k l m]: grain i and grain j, moved by k periods along x, l along y and
  m along z; in a box there are none. [Held k] is no contact but a row like one: coordinate k, of a fixed grain or of a
  wall that does not move, stays where it is. *)
Inductive contact := Image of nat & nat & Z & Z & Z | Lower of nat & nat | Upper of nat & nat | Held of nat.
Definition Disks (i j : nat) : contact := Image i j Z0 Z0 Z0.
Definition holds (c : contact) : bool := if c is Held _ then true else false.

Section Check.
Variables (n : nat) (q : seq Z) (contacts : seq contact).
Let N := (n.*2.+2)%N.

Definition coordinate (k : nat) : Z := nth Z0 q k.
Definition difference (i j a : nat) : Z := Z.sub (coordinate (j.*2 + a)) (coordinate (i.*2 + a)).

(** Minus the gradient of the gap, multiplied by the distance of the centres: approach velocity times distance. *)
Definition sparse_row (c : contact) : seq (nat * Z) :=
  match c with
  | Image i j _ _ _ => [:: (i.*2, difference i j 0); (i.*2 + 1, difference i j 1); (j.*2, difference j i 0);
    (j.*2 + 1, difference j i 1)]
  | Lower i a => [:: (i.*2 + a, Zneg xH)]
  | Upper i a => [:: (i.*2 + a, Zpos xH); (n.*2 + a, Zneg xH)]
  | Held k => [:: (k, Zpos xH)]
  end%N.

(** Names two disks, or a disk and an axis, of a packing of n disks in a box. Without this condition [Disks i n] would take
  the walls for a disk, and [Lower 0 5] would be [Lower 2 1]. *)
Definition well_formed (c : contact) : bool :=
  match c with
  | Image i j k l m => [&& i < n, j < n, i != j, k == Z0 & (l == Z0) && (m == Z0)]
  | Lower i a | Upper i a => (i < n) && (a < 2)
  | Held k => k < N
  end%N.

Fixpoint add_multiple (a : Z) (x sum : seq Z) : seq Z :=
  match x, sum with
  | b :: x', s :: sum' => Z.add (Z.mul a b) s :: add_multiple a x' sum'
  | _, _ => [::]
  end.
Definition combination (B : table) (r : seq (nat * Z)) : seq Z :=
  foldr (fun e sum => add_multiple e.2 (nth [::] B e.1) sum) (nseq N Z0) r.

Definition unit_row (p : Z) (l : nat) (x : seq Z) : bool :=
  all (fun zk => Z.eqb (Z.modulo (Z.sub zk.1 (if l == zk.2 then Zpos xH else Z0)) p) Z0) (zip x (iota 0 N)).

Definition certified (p : Z) (B : table) : bool :=
  [&& Z.ltb (Zpos xH) p, (size q == N) && (size contacts == N), (size B == N) && all (fun x => size x == N) B,
    all well_formed contacts
    & all (fun lc => unit_row p lc.1 (combination B (sparse_row lc.2))) (zip (iota 0 N) contacts)].

Local Open Scope ring_scope.
Let contact0 := Lower 0 0.
Definition sparse_entry (r : seq (nat * Z)) (k : nat) : Z := \sum_(e <- r | e.1 == k) e.2.
Definition integer_matrix : 'M[Z]_N := \matrix_(l, mu) sparse_entry (sparse_row (nth contact0 contacts l)) mu.

Lemma add_multiple_entry a x sum m : size x = m -> size sum = m ->
  size (add_multiple a x sum) = m /\ forall j, nth 0 (add_multiple a x sum) j = a * nth 0 x j + nth 0 sum j.
Proof.
elim: m x sum => [|m IH] [|b x] [|s sum] //= => [_ _|[sx] [ss]].
  by split=> // j; rewrite !nth_nil mulr0 addr0.
have [-> entry] := IH _ _ sx ss; split=> //; case=> [|j] //=.
Qed.

Lemma combination_entry (B : table) (r : seq (nat * Z)) : size B = N -> all (fun x => size x == N) B ->
  all (fun e => e.1 < N)%N r ->
  size (combination B r) = N /\ forall j, nth 0 (combination B r) j = \sum_(e <- r) e.2 * nth 0 (nth [::] B e.1) j.
Proof.
move=> sB /allP aB; elim: r => [_|e r IH].
  split=> [|j]; rewrite -[combination B [::]]/(nseq N Z0); first exact: size_nseq.
  by rewrite big_nil nth_nseq if_same.
case/andP=> eN /IH[sr entry]; rewrite -[combination B (e :: r)]/(add_multiple e.2 (nth [::] B e.1) (combination B r)).
have se : size (nth [::] B e.1) = N by apply/eqP/aB/mem_nth; rewrite sB.
have [s0 e0] := add_multiple_entry e.2 se sr.
by split=> // j; rewrite e0 entry big_cons.
Qed.

Lemma well_formed_rows_are_in_range c : well_formed c -> all (fun e => e.1 < N)%N (sparse_row c).
Proof. by case: c => [i j k l m|i a|i a|k] /=; rewrite /N; lia. Qed.

Lemma certified_inverse p (B : table) (l j : 'I_N) : certified p B ->
  Z.modulo (Z.sub ((integer_matrix *m \matrix_(k, m) nth 0 (nth [::] B k) m) l j) (if l == j then Zpos xH else Z0)) p
    = Z0.
Proof.
case/and5P=> _ /andP[_ /eqP sC] /andP[/eqP sB aB] /(all_nthP contact0) formed /(all_nthP (0%N, contact0)) rows.
have := rows l; rewrite size_zip size_iota sC minnn => /(_ (ltn_ord l)).
rewrite nth_zip ?size_iota // nth_iota // add0n; set r := sparse_row _ => /(all_nthP (0, 0%N)) unit.
have rN : all (fun e => e.1 < N)%N r by apply/well_formed_rows_are_in_range/formed; rewrite sC.
have [sr entry] := combination_entry sB aB rN.
have := unit j; rewrite size_zip size_iota sr minnn => /(_ (ltn_ord j)).
rewrite nth_zip ?size_iota // nth_iota // add0n.
rewrite -[fst _]/(nth 0 _ _) -[snd _]/(nat_of_ord j) -[nat_of_ord l == j]/(l == j) => /Z.eqb_eq zero;
  rewrite -[RHS]zero; congr (Z.modulo (Z.sub _ _) _).
rewrite entry !mxE; under eq_bigr => k _ do rewrite !mxE /sparse_entry -/r mulr_suml.
rewrite (exchange_big_dep xpredT) //=; apply: eq_big_seq => e er.
have eN : (e.1 < N)%N by move/allP: rN => /(_ _ er).
rewrite (bigD1 (Ordinal eN)) //= big1 ?addr0 // => k /andP[/eqP ek].
by rewrite -(inj_eq val_inj) /= ek eqxx.
Qed.

Theorem certificate_proves_regular p B : certified p B -> \det integer_matrix != 0.
Proof.
move=> ok; have /and5P[/Z.ltb_lt p1 _ _ _ _] := ok.
by apply: (inverse_modulo_proves_regular p1) => l j; apply: certified_inverse ok.
Qed.

(** The contact matrix G with unit normals over a real closed field; the unit of length drops out. *)
Variable F : rcfType.
Definition length_of (c : contact) : F :=
  match c with
  | Image i j _ _ _ => Num.sqrt ((int_of_Z (difference i j 0))%:~R ^+ 2 + (int_of_Z (difference i j 1))%:~R ^+ 2)
  | _ => 1
  end.
Definition contact_matrix : 'M[F]_N :=
  \matrix_(l, mu) ((int_of_Z (integer_matrix l mu))%:~R / length_of (nth contact0 contacts l)).

Theorem certificate_proves_isostatic p B :
  certified p B -> (forall l : 'I_N, length_of (nth contact0 contacts l) != 0) ->
  [/\ contact_matrix \in unitmx, \rank (kermx contact_matrix) = 0%N, \rank (kermx contact_matrix^T) = 0%N
    & forall load f : 'rV[F]_N, (f *m contact_matrix == load) = (f == forces contact_matrix load)].
Proof.
move=> /certificate_proves_regular/(regular_over_characteristic_0 F) regular lengths.
pose d : 'rV[F]_N := \row_l (length_of (nth contact0 contacts l))^-1.
have scaled : contact_matrix = diag_mx d *m map_mx (fun z => (int_of_Z z)%:~R : F) integer_matrix.
  by apply/matrixP=> l mu; rewrite mul_diag_mx !mxE mulrC.
have unit : contact_matrix \in unitmx.
  rewrite -row_free_unit /row_free scaled rank_of_scaled_rows ?(mxrank_unit regular) // => l.
  by rewrite mxE invr_eq0.
have := unit; rewrite {1}regular_iff_no_self_stress_no_mechanism => /andP[/eqP h0 /eqP k0].
by split=> // load f; apply: forces_exist_and_are_unique.
Qed.
(** Two different centres: a boolean that can be evaluated. *)
Definition distinct_centres : bool :=
  all (fun c => if c is Image i j _ _ _ then ~~ (Z.eqb (difference i j 0) Z0 && Z.eqb (difference i j 1) Z0) else true)
    contacts.

Lemma distinct_centres_have_lengths : size contacts = N -> distinct_centres ->
  forall l : 'I_N, length_of (nth contact0 contacts l) != 0.
Proof.
move=> sC /(all_nthP contact0) away l; have := away l; rewrite sC => /(_ (ltn_ord l)).
case: (nth _ _ _) => [i j ? ? ?|? ?|? ?|?] /=; rewrite ?oner_eq0 //.
apply: contra; set x := difference i j 0; set y := difference i j 1.
have zero (z : Z) : (int_of_Z z)%:~R ^+ 2 = 0 :> F -> Z.eqb z Z0.
  by move/eqP; rewrite sqrf_eq0 intr_eq0 => /eqP z0; apply/Z.eqb_eq/(can_inj int_of_ZK).
rewrite sqrtr_eq0 => le0; apply/andP.
have : (int_of_Z x)%:~R ^+ 2 + (int_of_Z y)%:~R ^+ 2 == 0 :> F by rewrite eq_le le0 addr_ge0 ?sqr_ge0.
by rewrite paddr_eq0 ?sqr_ge0 // => /andP[/eqP/zero ? /eqP/zero ?].
Qed.

(** What a certificate file concludes: every contact names two disks, or a disk and a wall, of the packing; and in the
  box the structure made of these contacts at these coordinates is isostatic. *)
Corollary certified_packing_is_isostatic p B :
  certified p B -> distinct_centres ->
  [/\ all well_formed contacts, contact_matrix \in unitmx, \rank (kermx contact_matrix) = 0%N, \rank (kermx contact_matrix^T) = 0%N
    & forall load f : 'rV[F]_N, (f *m contact_matrix == load) = (f == forces contact_matrix load)].
Proof.
move=> ok away; have /and5P[_ /andP[_ /eqP sC] _ formed _] := ok.
by have [] := certificate_proves_isostatic ok (distinct_centres_have_lengths sC away).
Qed.
End Check.

Print Assumptions certificate_proves_regular.
Print Assumptions certificate_proves_isostatic.
Print Assumptions certified_packing_is_isostatic.
