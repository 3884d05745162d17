(** Statement T3 (../exchange.md): exchanging one contact multiplies the determinant by the closing speed of the new
  gap. *)
From mathcomp Require Import all_ssreflect all_algebra.
Set Implicit Arguments.
Unset Strict Implicit.
Import GRing.Theory.
Local Open Scope ring_scope.

Section Exchange.
Variables (R : comRingType) (n : nat).

Definition exchange (G : 'M[R]_n) (l0 : 'I_n) (g : 'rV[R]_n) : 'M_n :=
  \matrix_(l, mu) if l == l0 then g 0 mu else G l mu.

(** No regularity is needed: any v that moves along l0 alone at unit approach velocity will do. *)
Theorem exchange_determinant (G : 'M[R]_n) (l0 : 'I_n) (g : 'rV[R]_n) (v : 'cV[R]_n) :
  G *m v = delta_mx l0 0 -> \det (exchange G l0 g) = \det G * (g *m v) 0 0.
Proof.
move=> Gv.
have cof mu : cofactor (exchange G l0 g) l0 mu = cofactor G l0 mu.
  rewrite /cofactor; congr (_ * \det _); apply/matrixP=> i j.
  by rewrite !mxE eq_sym (negPf (neq_lift _ _)).
have expansion : \det (exchange G l0 g) = (g *m \adj G *m delta_mx l0 (0 : 'I_1)) 0 0.
  rewrite (expand_det_row _ l0) -colE !mxE; apply: eq_bigr => mu _.
  by rewrite cof !mxE eqxx.
by rewrite expansion -Gv -mulmxA (mulmxA (\adj G)) mul_adj_mx mul_scalar_mx -scalemxAr mxE.
Qed.
End Exchange.

(** The structure after closing the new gap is isostatic iff the gap closes at non-zero speed. *)
Theorem isostatic_after_exchange (F : fieldType) (n : nat) (G : 'M[F]_n) (l0 : 'I_n) (g : 'rV[F]_n) :
  G \in unitmx ->
  (exchange G l0 g \in unitmx) = ((g *m (invmx G *m delta_mx l0 (0 : 'I_1))) 0 0 != 0).
Proof.
move=> regular.
rewrite !unitmxE (@exchange_determinant _ _ G l0 g (invmx G *m delta_mx l0 0)); last by rewrite mulKVmx.
by rewrite unitrM -unitmxE regular unitfE.
Qed.

Print Assumptions exchange_determinant.
Print Assumptions isostatic_after_exchange.
