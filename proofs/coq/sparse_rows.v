(** Matrices as lists of sparse rows of binary integers, and A^T A from its rows: one product for each two entries of
    a row. A row is a list of columns and entries; those of one column are added up, in any order. *)
From Coq Require Import ZArith List.
From mathcomp Require Import all_ssreflect all_algebra.
From mathcomp Require Import ssrZ zify ring.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.

Definition sparse := seq (N * Z).

(** a * row + sum. Rows in the order of their columns are merged into one. *)
Fixpoint merge_multiple (a : Z) (row : sparse) : sparse -> sparse :=
  match row with
  | [::] => fun sum => sum
  | (i, b) :: rest => fix merge_into (sum : sparse) : sparse :=
      match sum with
      | [::] => (i, Z.mul a b) :: merge_multiple a rest [::]
      | (j, c) :: others =>
          if N.eqb i j then (i, Z.add (Z.mul a b) c) :: merge_multiple a rest others
          else if N.ltb i j then (i, Z.mul a b) :: merge_multiple a rest sum
          else (j, c) :: merge_into others
      end
  end.

Fixpoint update (T : Type) (k : nat) (f : T -> T) (l : seq T) : seq T :=
  match k, l with
  | _, [::] => [::]
  | 0, x :: rest => f x :: rest
  | k'.+1, x :: rest => x :: update k' f rest
  end.

(** Adds c times the products of the entries of a row with each other to the rows of a table. *)
Definition add_products (c : Z) (row : sparse) (table : seq sparse) : seq sparse :=
  foldr (fun e => update (N.to_nat e.1) (merge_multiple (Z.mul c e.2) row)) table row.
Definition add_all_products (c : Z) (rows table : seq sparse) : seq sparse := foldr (add_products c) table rows.
Definition diagonal (m : nat) (a : Z) : seq sparse := [seq [:: (N.of_nat i, a)] | i <- iota 0 m].
Definition sizes (row : sparse) : Z := foldr (fun e => Z.add (Z.abs e.2)) Z0 row.

Local Open Scope ring_scope.
Definition entry (row : sparse) (j : nat) : Z := \sum_(e <- row | N.to_nat e.1 == j) e.2.

Lemma entry_cons e row j : entry (e :: row) j = (if N.to_nat e.1 == j then e.2 else 0) + entry row j.
Proof. by rewrite /entry big_cons; case: ifP => _; rewrite ?add0r. Qed.

Lemma merge_multiple_entry a row sum j : entry (merge_multiple a row sum) j = a * entry row j + entry sum j.
Proof.
elim: row sum => [|[i b] rest IH] sum; first by rewrite /entry big_nil mulr0 add0r.
elim: sum => [|[k c] others IHs].
  by rewrite !entry_cons IH /= /entry big_nil !addr0 mulrDr; case: ifP; rewrite ?mulr0.
rewrite [merge_multiple _ _ _]/=; case: N.eqb_spec => [<-|_].
  rewrite !entry_cons IH /=; move: (entry rest j) (entry others j) => s t.
  by case: ifP => _; rewrite -?[Z.add _ _]/(_ + _) -?[Z.mul _ _]/(_ * _); ring.
case: ifP => _; rewrite ![entry (_ :: _) j]entry_cons.
  rewrite IH entry_cons /=; move: (entry rest j) (entry others j) => s t.
  by case: (_ == _); case: (_ == _); rewrite -?[Z.mul _ _]/(_ * _); ring.
rewrite -/(merge_multiple a ((i, b) :: rest)) IHs entry_cons /=; move: (entry rest j) (entry others j) => s t.
by case: (_ == _); case: (_ == _); ring.
Qed.

Lemma size_update (T : Type) k (f : T -> T) l : size (update k f l) = size l.
Proof. by elim: l k => [|x l IH] [|k] //=; rewrite IH. Qed.
Lemma nth_update (T : Type) (x : T) k f l i : (i < size l)%N ->
  nth x (update k f l) i = if k == i then f (nth x l i) else nth x l i.
Proof. by elim: l k i => [|y l IH] [|k] [|i] //= small; rewrite IH. Qed.

Lemma add_products_entry c row table i j : size (add_products c row table) = size table /\
  ((i < size table)%N -> entry (nth [::] (add_products c row table) i) j
    = c * (entry row i * entry row j) + entry (nth [::] table i) j).
Proof.
rewrite /add_products; have general part : size (foldr (fun e => update (N.to_nat e.1) (merge_multiple (Z.mul c e.2) row)) table part) = size table /\
    ((i < size table)%N -> entry (nth [::] (foldr (fun e => update (N.to_nat e.1) (merge_multiple (Z.mul c e.2) row)) table part) i) j
    = c * (entry part i * entry row j) + entry (nth [::] table i) j).
  elim: part => [|e part [sIH IH]] /=; first by split=> // _; rewrite /entry big_nil mul0r mulr0 add0r.
  rewrite size_update sIH; split=> // small; rewrite nth_update ?sIH // entry_cons.
  case: ifP => _; last by rewrite IH // add0r.
  rewrite merge_multiple_entry IH // -[Z.mul c e.2]/(c * e.2).
  move: (entry part i) (entry row j) (entry (nth _ _ _) j) => s t u; ring.
exact: general.
Qed.

Lemma add_all_products_entry c rows table i j : size (add_all_products c rows table) = size table /\
  ((i < size table)%N -> entry (nth [::] (add_all_products c rows table) i) j
    = c * (\sum_(row <- rows) entry row i * entry row j) + entry (nth [::] table i) j).
Proof.
elim: rows => [|row rows [sIH IH]]; first by split=> // _; rewrite big_nil mulr0 add0r.
have [sr rest] := add_products_entry c row (add_all_products c rows table) i j.
split=> [|small]; first by rewrite -sIH -sr.
by rewrite [add_all_products _ _ _]/= rest ?sIH // IH // big_cons mulrDr addrA.
Qed.

Lemma size_diagonal m a : size (diagonal m a) = m. Proof. by rewrite size_map size_iota. Qed.
Lemma diagonal_entry m a i j : (i < m)%N -> entry (nth [::] (diagonal m a) i) j = if i == j then a else 0.
Proof.
move=> im; rewrite (nth_map 0%N) ?size_iota // nth_iota // entry_cons /entry big_nil addr0 /=.
by rewrite (_ : N.to_nat _ = i) ?add0n //; lia.
Qed.

(** The entries of a row, as a matrix has them, are not larger in sum than those of the list. *)
Lemma sizes_are_larger (F : realFieldType) (phi : {rmorphism Z -> F}) m row : (forall z, `|phi z| = phi (Z.abs z)) ->
  \sum_(j < m) `|phi (entry row j)| <= phi (sizes row).
Proof.
move=> abs; elim: row => [|e row IH]; first by rewrite big1 => [|j _]; rewrite /entry ?big_nil rmorph0 ?normr0.
rewrite /sizes /= -/(sizes row) -[Z.add _ _]/(Z.abs e.2 + sizes row) rmorphD /= -abs.
apply: le_trans (ler_add (lexx _) IH).
under eq_bigr => j _ do rewrite entry_cons rmorphD.
apply: le_trans (_ : \sum_(j < m) (`|phi (if N.to_nat e.1 == j then e.2 else 0)| + `|phi (entry row j)|) <= _).
  by apply: ler_sum => j _; apply: ler_norm_add.
rewrite big_split ler_add2r; case: (ltnP (N.to_nat e.1) m) => [small|large].
  rewrite (bigD1 (Ordinal small)) //= eqxx big1 ?addr0 // => j ne; case: eqP => [same|]; last by rewrite rmorph0 normr0.
  by case/eqP: ne; apply: val_inj.
rewrite big1 // => j _; case: eqP => [same|]; last by rewrite rmorph0 normr0.
by move: (ltn_ord j); rewrite -same ltnNge large.
Qed.

(** Rows with natural numbers as columns, put in order. *)
Definition in_order (e d : N * Z) : bool := N.leb e.1 d.1.
Definition sparse_of (row : seq (nat * Z)) : sparse := sort in_order [seq (N.of_nat e.1, e.2) | e <- row].
Lemma sparse_of_entry row j : entry (sparse_of row) j = \sum_(e <- row | e.1 == j) e.2.
Proof.
rewrite /entry (perm_big _ (permEl (perm_sort _ _))) big_map.
by apply: eq_bigl => e /=; rewrite (_ : N.to_nat _ = e.1) //; lia.
Qed.

Definition matrix_of (m : nat) (rows : seq sparse) : 'M[Z]_m := \matrix_(i, j) entry (nth [::] rows i) j.

Print Assumptions add_all_products_entry.
Print Assumptions sizes_are_larger.
