(** Statement T7, step 1 (../generic_isostaticity.md): no line separates the contacts that push from those that pull.

    A null vector f of the gaps' derivative with respect to positions and radii satisfies, at each disk, sum f_l n_l = 0 and sum f_l = 0.
    If some line a . n = c left every n_l with f_l > 0 on one closed side and every n_l with f_l < 0 on the other, all of them would lie
    on the line. On a circle a line cuts two arcs: with at most two sign changes around the disk such a line exists. *)
From mathcomp Require Import all_ssreflect all_algebra.
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

(** Around a wall all normals are equal; what is left is sum f = 0: both signs occur as soon as one force is not zero. *)
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

Print Assumptions no_separating_line.
Print Assumptions both_signs_at_a_wall.
