(* The results of questions/arithmetic.v, one a line. *)
let () = List.iter (fun z -> print_endline (Z.to_string z)) Arithmetic.results
