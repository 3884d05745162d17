(** Statement T7, step 1 (../generic_isostaticity.md): no line separates the contacts that push from those that pull.

    A null vector f of the gaps' derivative with respect to positions and radii satisfies, at each disk,
      sum f_l n_l = 0 and sum f_l = 0.
    If some line a . n = c left every n_l with f_l > 0 on one closed side and every n_l with f_l < 0 on the other,
      all of them would lie
    on the line. On a circle a line cuts two arcs: with at most two sign changes around the disk such a line exists. *)
From mathcomp Require Import all_ssreflect all_algebra zify ring.
Set Implicit Arguments.
Unset Strict Implicit.
Import Order.Theory GRing.Theory Num.Theory.
Local Open Scope ring_scope.

Theorem no_separating_line (F : realFieldType) (z : nat) (n1 n2 f : 'I_z -> F) (a1 a2 c : F) :
  \sum_l f l = 0 -> \sum_l f l * n1 l = 0 -> \sum_l f l * n2 l = 0 ->
  (forall l, 0 <= f l * (a1 * n1 l + a2 * n2 l - c)) ->
  forall l, f l != 0 -> a1 * n1 l + a2 * n2 l = c.
Proof.
move=> s0 s1 s2 side l fl.
have total : \sum_l f l * (a1 * n1 l + a2 * n2 l - c) = 0.
  under eq_bigr => i _ do rewrite mulrBr mulrDr mulrCA (mulrCA (f i)).
  by rewrite sumrB big_split /= -!mulr_sumr -mulr_suml s0 s1 s2 !mulr0 mul0r subr0 addr0.
move/eqP: total; rewrite psumr_eq0 => [|i _]; last exact: side.
by move=> /allP/(_ l (mem_index_enum _)); rewrite /= mulf_eq0 (negPf fl) subr_eq0 => /eqP.
Qed.

(** Around a wall all normals are equal; what is left is sum f = 0: both signs occur as soon as one force is not zero.
  *)
Theorem both_signs_at_a_wall (F : realFieldType) (z : nat) (f : 'I_z -> F) (l : 'I_z) :
  \sum_l f l = 0 -> f l != 0 -> (exists i, 0 < f i) /\ (exists j, f j < 0).
Proof.
move=> s0 fl.
have one (g : 'I_z -> F) : \sum_i g i = 0 -> g l != 0 -> exists i, 0 < g i.
  move=> gs gl; apply/existsP; apply: contraNT gl; rewrite negb_exists => /forallP none.
  have neg i : 0 <= - g i by rewrite oppr_ge0 leNgt.
  have : \sum_i - g i = 0 by rewrite sumrN gs oppr0.
  move/eqP; rewrite psumr_eq0 => [|i _]; last exact: neg.
  by move=> /allP/(_ l (mem_index_enum _)); rewrite /= oppr_eq0.
split; first exact: one.
have [i] : exists i, 0 < - f i by apply: one; rewrite ?sumrN ?s0 ?oppr0 // oppr_eq0.
by rewrite oppr_gt0; exists i.
Qed.

(** Four changes. First the words: a cyclic word with fewer than four changes is a block and its complement. *)
Section Words.
Fixpoint steps (x : bool) (t : seq bool) : nat := if t is y :: t' then ((x != y) + steps y t')%N else 0%N.
Definition cyclic_changes (w : seq bool) : nat := if w is x :: t then steps x (rcons t x) else 0%N.

Lemma odd_steps x t : odd (steps x t) = (x != last x t).
Proof. by elim: t x => [|y t IH] x /=; rewrite ?eqxx // oddD IH oddb; case: x y (last y t) => [] [] []. Qed.

Lemma steps_rcons x t y : (steps x t <= steps x (rcons t y))%N.
Proof. by elim: t x => //= z t IH x; rewrite leq_add2l. Qed.

Lemma one_run x t : (steps x t <= 0)%N -> t = nseq (size t) x.
Proof. by elim: t x => //= y t IH x; case: eqP => [<- /= /IH {1}->|_] //; rewrite addnC ltn0. Qed.

Lemma two_runs x t : (steps x t <= 1)%N -> exists a c, t = nseq a x ++ nseq c (~~ x).
Proof.
elim: t x => [|y t IH] x /=; first by exists 0%N, 0%N.
case: (eqVneq x y) => [<- /= /IH[a [c ->]]|ne]; first by exists a.+1, c.
rewrite add1n ltnS => /one_run ->; exists 0%N, (size t).+1; congr (_ :: _); first by case: x y ne => [] [].
by case: x y ne => [] [].
Qed.

Lemma three_runs x t : (steps x t <= 2)%N -> exists a c d, x :: t = nseq a x ++ nseq c (~~ x) ++ nseq d x.
Proof.
elim: t x => [|y t IH] x /=; first by exists 1%N, 0%N, 0%N.
case: (eqVneq x y) => [<- /= /IH[a [c [d ->]]]|ne]; first by exists a.+1, c, d.
rewrite add1n ltnS => /two_runs[a [c ->]]; exists 1%N, a.+1, c.
by case: x y ne => [] [] //=.
Qed.

Lemma few_changes_make_a_block w : (cyclic_changes w < 4)%N ->
  exists b a c, (a + c <= size w)%N /\ forall i, (i < size w)%N -> nth b w i = (a <= i < a + c)%N (+) b.
Proof.
case: w => [|x t] few; first by exists false, 0%N, 0%N.
have even : ~~ odd (steps x (rcons t x)) by rewrite odd_steps last_rcons eqxx.
have two : (steps x (rcons t x) <= 2)%N by move: even few; rewrite /= -dvdn2 => /dvdnP[k ->]; lia.
have [a [c [d E]]] := three_runs (leq_trans (steps_rcons x t x) two).
exists x, a, c; rewrite E !size_cat !size_nseq addnA leq_addr; split=> // i _.
rewrite !nth_cat !size_nseq !nth_nseq; case: ltnP => ia /=; first by case: x {even two few E}.
have -> : (i - a < c)%N = (i < a + c)%N by lia.
by case: ltnP => _ /=; rewrite ?if_same //; case: x {even two few E}.
Qed.
End Words.

(** Then the points, numbered around a strictly convex polygon (points of a circle in counterclockwise order are). *)
Section Disk.
Variables (F : realFieldType) (z : nat) (n1 n2 : 'I_z -> F).
Definition orient (i j k : 'I_z) : F := (n1 j - n1 i) * (n2 k - n2 i) - (n2 j - n2 i) * (n1 k - n1 i).
Hypothesis convex : forall i j k : 'I_z, (i < j < k)%N -> 0 < orient i j k.
Hypothesis distinct : forall i j : 'I_z, n1 i = n1 j -> n2 i = n2 j -> i = j.

Lemma orient_cycle i j k : orient i j k = orient j k i. Proof. by rewrite /orient; ring. Qed.
Lemma orient_swap i j k : orient i k j = - orient i j k. Proof. by rewrite /orient; ring. Qed.
Lemma orient_same i j : orient i j j = 0. Proof. by rewrite /orient; ring. Qed.
Lemma orient_start i j : orient i j i = 0. Proof. by rewrite /orient; ring. Qed.

Definition null (f : 'I_z -> F) :=
  [/\ \sum_l f l = 0, \sum_l f l * n1 l = 0, \sum_l f l * n2 l = 0 & forall l, f l != 0].

Lemma weakly_separated (f : 'I_z -> F) (p q : 'I_z) : null f ->
  (forall l, 0 <= f l * - orient p q l) -> forall l, orient p q l = 0.
Proof.
move=> [s0 s1 s2 nz] side l.
have E m : (n2 q - n2 p) * n1 m + - (n1 q - n1 p) * n2 m - ((n2 q - n2 p) * n1 p - (n1 q - n1 p) * n2 p) = - orient p
  q m.
  by rewrite /orient; ring.
have := @no_separating_line F z n1 n2 f _ _ _ s0 s1 s2 (fun m => eq_ind_r (fun x =>
  0 <= f m * x) (side m) (E m)) l (nz l).
by move/eqP; rewrite -subr_eq0 E oppr_eq0 => /eqP.
Qed.

Lemma no_block (f : 'I_z -> F) (a c : nat) : (0 < z)%N -> (a + c <= z)%N -> null f ->
  ~ (forall i : 'I_z, (0 < f i) = (a <= i < a + c)%N).
Proof.
move=> z0 range nf block; have [s0 s1 s2 nz] := nf.
have [[i fi] [j fj]] := both_signs_at_a_wall s0 (nz (Ordinal z0)).
have negative (l : 'I_z) : ~~ (a <= l < a + c)%N -> f l < 0 by rewrite -block -leNgt => le0; rewrite lt_neqAle nz.
have inblock := block i; rewrite fi in inblock; have c0 : (0 < c)%N by move: inblock; lia.
have outside : ~~ (a <= j < a + c)%N by rewrite -block -leNgt ltW.
have az : (a < z)%N by lia.
pose p := Ordinal az.
have side (q : 'I_z) : (forall l : 'I_z, (a <= l < a + c)%N -> orient p q l <= 0) ->
  (forall l : 'I_z, ~~ (a <= l < a + c)%N -> 0 <= orient p q l) ->
    forall l, orient p q l = 0.
  move=> inside out; apply: (weakly_separated nf) => l; rewrite mulrN -mulNr.
  case E : (a <= l < a + c)%N; last by rewrite mulr_ge0 ?out ?E // oppr_ge0 ltW ?negative ?E.
  by rewrite mulNr -mulrN mulr_ge0 ?oppr_ge0 ?inside ?E // ltW ?block.
case: (ltnP 1 c) => c1.
  have qz : ((a + c).-1 < z)%N by lia.
  pose q := Ordinal qz.
  have out (l : 'I_z) : ~~ (a <= l < a + c)%N -> 0 < orient p q l.
    move=> nl; case: (ltnP l a) => la; last by apply: convex => /=; lia.
    by rewrite -orient_cycle; apply: convex => /=; lia.
  have all0 := side q; move: (out j outside); rewrite all0 ?ltxx // => l; last by move/out/ltW.
  move=> nl; case: (eqVneq l p) => [->|lp]; first by rewrite orient_start.
  case: (eqVneq l q) => [->|lq]; first by rewrite orient_same.
  rewrite -[q]/q orient_swap oppr_le0 ltW //; apply: convex; move: lp lq nl; rewrite -!(inj_eq val_inj) /=; lia.
have cE : c = 1%N by lia.
have one (l : 'I_z) : (a <= l < a + c)%N -> l = p by move=> nl; apply: val_inj => /=; lia.
have [q [qp others]] : exists q, q != p /\ forall l, l != p -> l != q -> 0 < orient p q l.
  case: (ltnP a.+1 z) => next.
    exists (Ordinal next); split; first by rewrite -(inj_eq val_inj) /=; lia.
    move=> l; rewrite -!(inj_eq val_inj) /= => lp lq.
    case: (ltnP l a) => la; last by apply: convex => /=; lia.
    by rewrite -orient_cycle; apply: convex => /=; lia.
  have ja : (j < a)%N by move: outside (ltn_ord j); lia.
  exists (Ordinal z0); split; first by rewrite -(inj_eq val_inj) /=; lia.
  move=> l; rewrite -!(inj_eq val_inj) /= => lp lq; rewrite orient_cycle; apply: convex => /=.
  by move: (ltn_ord l); lia.
have all0 : forall l, orient p q l = 0.
  apply: side => l; first by move/one ->; rewrite orient_start.
  move=> nl; case: (eqVneq l p) => [->|lp]; first by rewrite orient_start.
  by case: (eqVneq l q) => [->|lq]; rewrite ?orient_same // ltW ?others.
have two l : l != p -> l = q.
  by move=> lp; case: (eqVneq l q) => // lq; move: (others l lp lq); rewrite all0 ltxx.
have sum (g : 'I_z -> F) : \sum_l g l = g p + g q.
  rewrite (bigD1 p) //= (bigD1 q) //= big1 ?addr0 // => l /andP[lp lq].
  by rewrite (two l lp) eqxx in lq.
rewrite !sum in s0 s1 s2.
have fq : f q = - f p by apply/eqP; rewrite -addr_eq0 addrC s0.
have same (g : 'I_z -> F) : f p * g p + f q * g q = 0 -> g p = g q.
  by rewrite fq mulNr -mulrBr => /eqP; rewrite mulf_eq0 (negPf (nz p)) subr_eq0 => /eqP.
by move: qp; rewrite (distinct (same _ s1) (same _ s2)) eqxx.
Qed.

Theorem at_least_four_sign_changes (f : 'I_z -> F) : (0 < z)%N -> null f ->
  (4 <= cyclic_changes [seq (0 < f i)%R | i <- enum 'I_z])%N.
Proof.
move=> z0 nf; rewrite leqNgt; apply/negP => /few_changes_make_a_block; rewrite size_map size_enum_ord.
case=> [b [a [c [range block]]]]; have [s0 s1 s2 nz] := nf.
have at_ (i : 'I_z) : (0 < f i) = (a <= i < a + c)%N (+) b.
  by rewrite -block // (nth_map i) ?size_enum_ord // nth_ord_enum.
case: b {block} at_ => at_; last by apply: (no_block z0 range nf) => i; rewrite at_ addbF.
have neg : null (fun i => - f i).
  by split=> [|||l]; rewrite ?oppr_eq0 //; under eq_bigr do rewrite ?mulNr; rewrite sumrN ?s0 ?s1 ?s2 oppr0.
apply: (no_block z0 range neg) => i; rewrite oppr_gt0 -[RHS]addbF -[false]/(true (+) true) addbA -at_ addbT.
by rewrite ltNge le_eqVlt eq_sym (negPf (nz i)).
Qed.
End Disk.

Print Assumptions at_least_four_sign_changes.
Print Assumptions no_separating_line.
Print Assumptions both_signs_at_a_wall.
