"""Forms of the smoothed gradient on T6: bases, blends, weights, and their operators."""
from step import *
CORN=np.eye(3); MID=np.array([[.5,.5,0],[0,.5,.5],[.5,0,.5]]); NODES=np.vstack([CORN,MID])
def smooth(t): return t*t*(3-2*t)
def alpha(L,f):
    b=np.clip(27*L.prod(1),0,1); m=np.minimum(1,np.clip(L.min(1),0,1)/.2)
    if f=='27': return b
    if f=='min': return m
    if f=='sm': return smooth(b)
    if f=='sq': return b*b
    if f=='msm': return smooth(m)
    if f=='0': return 0*b
    if f=='rt': return np.sqrt(b)
    if f=='4': return np.minimum(1,2*b)
    if f=='m1': return smooth(np.minimum(1,np.clip(L.min(1),0,1)/.1))
    if f=='m05': return smooth(np.minimum(1,np.clip(L.min(1),0,1)/.05))
    if f[0]=='c': return np.minimum(float(f[1:]),b)
    raise ValueError(f)
MB=np.full((3,3),1/630.)+np.eye(3)*(1/420.-1/630.)
SL=np.zeros((6,3)); SL[:3]=-1/60.; SL[:3]+=np.eye(3)*(1/30.+1/60.)
for q,(i,j,k) in enumerate(((0,1,2),(1,2,0),(2,0,1))): SL[3+q,[i,j]]=2/15.; SL[3+q,k]=1/15.
def bubpsi(L,mc,mm):
    m=np.array([mc]*3+[mm]*3); c=np.linalg.solve(MB,(m[:,None]*NODES-SL).T).T   # 6x3
    l1,l2,l3=L.T; S=np.stack([l1*(2*l1-1),l2*(2*l2-1),l3*(2*l3-1),4*l1*l2,4*l2*l3,4*l3*l1],1)
    return S+L.prod(1)[:,None]*(L@c.T)
class DM(Mesh):
    basis='quad'; al='27'; shift=False; vw=None
    def smoothing(s,active):
        """list over d of G (nS x nn), and function S(el,L)->(cols,vals)"""
        ac=np.where(active)[0]; b=s.basis; out=[]
        def gather(nodes,Ls,w,ns):
            # nodes (nac,q) smoothing node ids; sampled at Ls (q) ; weight w (nac,q)
            W=np.zeros(ns); np.add.at(W,nodes,w); W[W==0]=1; g=[s.dN(ac,np.tile(l,(len(ac),1))) for l in Ls]
            res=[]
            for d in(0,1):
                r=np.concatenate([np.repeat(nodes[:,q],6) for q in range(len(Ls))]); c=np.tile(s.T[ac].ravel(),len(Ls))
                v=np.concatenate([(g[q][:,:,d]*w[:,q,None]).ravel() for q in range(len(Ls))])
                res.append(sp.diags(1/W)@sp.csr_matrix((v,(r,c)),shape=(ns,s.nn)))
            return res
        A=s.A[ac,None]
        if b in('quad','quadown','split','bub','dbub'):
            G=gather(s.T[ac],NODES,np.repeat(A,6,1),s.nn)
        elif b=='hats': G=gather(s.T[ac,:3],CORN,np.repeat(A,3,1),s.nv)
        elif b=='hat':
            W=np.zeros(s.nv); np.add.at(W,s.T[ac,:3],np.repeat(A/3,3,1)); W[W==0]=1
            rr=np.repeat(s.T[ac,:3],6,axis=1).ravel(); cc=np.tile(s.T[ac],(1,3)).ravel()
            G=[sp.diags(1/W)@sp.csr_matrix((s.Gc[ac,:,:,d].ravel(),(rr,cc)),shape=(s.nv,s.nn)) for d in(0,1)]
        elif b=='zz': # linear LSQ of sampled mid-point gradients over the patch, evaluated at the vertex
            rows=[];cols=[];V=[[],[]]
            inc=[[] for _ in range(s.nv)]
            for e in ac:
                for v in s.T[e,:3]: inc[v].append(e)
            g=[s.dN(np.arange(s.ne),np.tile(l,(s.ne,1))) for l in MID]
            pos=[np.einsum('a,eai->ei',l,s.X[s.T[:,:3]]) for l in MID]
            for v in range(s.nv):
                if not inc[v]: continue
                es=inc[v]; P=[];wt=[]
                for e in es:
                    for q in range(3): P.append((pos[q][e]-s.X[v])/s.h); wt.append(s.A[e])
                P=np.c_[np.ones(len(P)),P]; wt=np.array(wt); N_=P.T@(wt[:,None]*P); co=np.linalg.solve(N_,(P*wt[:,None]).T)[0]
                k=0
                for e in es:
                    for q in range(3):
                        rows+= [v]*6; cols+=list(s.T[e]); V[0]+=list(co[k]*g[q][e][:,0]); V[1]+=list(co[k]*g[q][e][:,1]); k+=1
            G=[sp.csr_matrix((V[d],(rows,cols)),shape=(s.nv,s.nn)) for d in(0,1)]
        return G
    def ops(s,el,L,scheme='plain',active=None):
        n=len(el); g=s.dN(el,L); r=np.repeat(np.arange(n),6); c=s.T[el].ravel()
        B=[sp.csr_matrix((g[:,:,d].ravel(),(r,c)),shape=(n,s.nn)) for d in(0,1)]
        if s.basis=='plain': out=B
        else:
            b=s.basis
            if b in('bub','dbub'):
                G=s.smoothing(active); psi=bubpsi(L,*s.al) if b=='bub' or s.pw is None else s.dpsi(el,L,s.pw)
                ri=np.repeat(np.arange(n),6); ci=s.T[el].ravel()
                H=sp.csr_matrix((psi.ravel(),(ri,ci)),shape=(n,s.nn)); out=[]
                loc=np.zeros((n,6,2))
                for q in range(6): loc+=psi[:,q,None,None]*s.dN(el,np.tile(NODES[q],(n,1)))
                return [(B[d]+H@G[d]-sp.csr_matrix((loc[:,:,d].ravel(),(ri,ci)),shape=(n,s.nn))).tocsr() for d in(0,1)]
            a=alpha(L,s.al); G=s.smoothing(active)
            if b in('quad','quadown'): H=sp.csr_matrix((s.N(L).ravel(),(np.repeat(np.arange(n),6),s.T[el].ravel())),shape=(n,s.nn))
            elif b=='split':
                v=np.zeros((n,6)); l1,l2,l3=L.T
                for q,(i,j,k) in enumerate(((0,3,5),(3,1,4),(5,4,2))):
                    m=L[:,q]>=.5; ll=2*L.copy(); ll[:,q]-=1; 
                    # corner sub-triangle q: nodes (corner q, its two mids)
                    nodes=[q]; mids={0:(3,5),1:(3,4),2:(4,5)}[q]; oth={0:(1,2),1:(0,2),2:(1,2) and (1,0)}[q]
                    v[m,q]=ll[m,q]
                    for mm,o in zip(mids,oth): v[m,mm]=ll[m,o]
                m=L.max(1)<.5
                v[m,3]=1-2*L[m,2]; v[m,4]=1-2*L[m,0]; v[m,5]=1-2*L[m,1]
                H=sp.csr_matrix((v.ravel(),(np.repeat(np.arange(n),6),s.T[el].ravel())),shape=(n,s.nn))
            else: H=sp.csr_matrix((L.ravel(),(np.repeat(np.arange(n),3),s.T[el,:3].ravel())),shape=(n,s.nv))
            out=[(sp.diags(a)@B[d]+sp.diags(1-a)@(H@G[d])).tocsr() for d in(0,1)]
        return out
    scale=False; pw=None; lim=1e-2; cap=3.; nfall=0
    def dpsi(s,el,L,w):
        m=np.array([s.al[0]]*3+[s.al[1]]*3); b=L.prod(1)
        t=np.bincount(el,w,s.ne); 
        def cs(v): 
            o=np.zeros((s.ne,)+v.shape[1:]); np.add.at(o,el,v); return o
        M=cs(w[:,None,None]*b[:,None,None]*L[:,:,None]*L[:,None,:]); S=s.N(L)
        R=cs(w[:,None,None]*S[:,:,None]*L[:,None,:])  # ne,6,3
        rhs=t[:,None,None]*(m[:,None]*NODES)[None]-R
        # relative regularisation against exact moments
        c0=np.linalg.solve(MB,(m[:,None]*NODES-SL).T).T
        Mx=M/np.where(t>0,t,1)[:,None,None]; q=np.linalg.inv(np.linalg.cholesky(MB)); ev=np.linalg.eigvalsh(q@Mx@q.T)[:,0]
        ok=ev>s.lim
        c=np.tile(c0,(s.ne,1,1)); 
        c[ok]=np.swapaxes(np.linalg.solve(M[ok],np.swapaxes(rhs[ok],1,2)),1,2)
        s.nfall=((~ok)&(t>0)).sum()/(t>0).sum()
        psi=S+b[:,None]*np.einsum('pk,pak->pa',L,c[el])
        return psi
    def cutinfo(s,act):
        av=np.zeros(s.nv,bool); av[s.T[~act,:3].ravel()]=True; s.full=act&~av[s.T[:,:3]].any(1)
    def weights(s,el,Vn):
        if not s.scale: return Vn
        t=np.bincount(el,Vn,s.ne); f=np.where(s.full,s.A/np.where(t>0,t,1),1); return Vn*f[el]
    def shifted(s,out,el,Vn):
        w=Vn; t=np.bincount(el,w,s.ne); n=len(el)
        C=sp.csr_matrix((w,(el,np.arange(n))),shape=(s.ne,n))
        P,W=seeds(12); fe=np.where(s.full)[0]; e2=np.repeat(fe,12); s.shift=False
        act=np.zeros(s.ne,bool); act[el]=True
        Bx=s.ops(e2,np.tile(P,(len(fe),1)),'ddmp',act); s.shift=True
        CX=sp.csr_matrix((np.tile(W,len(fe))*s.A[e2],(e2,np.arange(len(e2)))),shape=(s.ne,len(e2)))
        E=sp.csr_matrix((np.where(s.full[el],1/t[el],0),(np.arange(n),el)),shape=(n,s.ne))
        return [(out[d]+E@(CX@Bx[d]-C@out[d])).tocsr() for d in(0,1)]
    def exact_cell(s,el,active):
        """int over each cell of plain grad N (ne x nn)"""
        ac=np.where(active)[0]; g=s.dN(ac,np.full((len(ac),3),1/3.))*s.A[ac,None,None]
        return [sp.csr_matrix((g[:,:,d].ravel(),(np.repeat(ac,6),s.T[ac].ravel())),shape=(s.ne,s.nn)) for d in(0,1)]
def lattice(mesh,per,off,theta=0.3,box=None):
    A=mesh.A.mean(); d=np.sqrt(A/per); lo=mesh.X.min(0);hi=mesh.X.max(0); n=int(3*max(hi-lo)/d)
    i,j=np.meshgrid(np.arange(-n,n),np.arange(-n,n)); P=np.c_[i.ravel(),j.ravel()]*d; c,s_=np.cos(theta),np.sin(theta)
    P=P@np.array([[c,-s_],[s_,c]])+np.array(off)*d+.5*(lo+hi); P=P[((P>lo)&(P<hi)).all(1)]
    return P,d*d
def crossing(basis,al,per,seed=1,n=8):
    m=DM(np.linspace(0,1,n+1),np.linspace(0,1,n+1),seed=seed); m.basis=basis;m.al=al
    act=np.ones(m.ne,bool); inner=((m.X>1.5/n)&(m.X<1-1.5/n)).all(1); R=[]
    rng=np.random.default_rng(0)
    ref=np.zeros(m.nn)
    for l in MID: np.add.at(ref,m.T.ravel(),(np.linalg.norm(m.dN(np.arange(m.ne),np.tile(l,(m.ne,1))),axis=2)*m.A[:,None]/3).ravel())
    for t in range(8):
        P,v=lattice(m,per,rng.uniform(0,1,2),theta=.2+.1*t); el,L=m.locate(P); B=m.ops(el,L,'ddmp',act)
        f=np.stack([v*np.asarray(b.sum(0)).ravel() for b in B],1)
        R.append((np.linalg.norm(f,axis=1)/ref)[inner])
    R=np.array(R); return np.sqrt((R**2).mean()),R.max()
def stiff(m,el,L,w,act,nu=.3):
    Lam=nu/(1+nu)/(1-2*nu); G=.5/(1+nu); B=m.ops(el,L,'ddmp',act); W=sp.diags(w)
    kxx=B[0].T@W@B[0]; kyy=B[1].T@W@B[1]; kxy=B[0].T@W@B[1]
    return sp.bmat([[(Lam+2*G)*kxx+G*kyy,Lam*kxy+G*kxy.T],[Lam*kxy.T+G*kxy,(Lam+2*G)*kyy+G*kxx]]).toarray(),B
def rank(basis,al,k,seed=1,n=4,holes=False,gen=False):
    m=DM(np.linspace(0,1,n+1),np.linspace(0,1,n+1),seed=seed); m.basis=basis;m.al=al
    P,W=seeds(k) if k!=1 else (np.full((1,3),1/3.),np.ones(1)); x=np.einsum('qa,ead->eqd',P,m.X[m.T[:,:3]]).reshape(-1,2); w=(m.A[:,None]*W).ravel()
    if gen: x,v=lattice(m,k,(.3,.7)); w=np.full(len(x),v)
    if holes: 
        keep=m.cent[m.locate(x)[0]][:,1]+.3*m.cent[m.locate(x)[0]][:,0]<.75; x=x[keep]; w=w[keep]
    el,L=m.locate(x); act=np.zeros(m.ne,bool); act[el]=True
    K,_=stiff(m,el,L,w,act); used=np.zeros(m.nn,bool); used[m.T[act].ravel()]=True; i=np.where(np.r_[used,used])[0]
    ev=np.linalg.eigvalsh(K[np.ix_(i,i)]); return (abs(ev)<1e-10*ev[-1]).sum()-3, ev[3]/ev[-1]
def infsup(basis,al,n,seed=1,k=16):
    m=DM(np.linspace(0,1,n+1),np.linspace(0,1,n+1),seed=seed); m.basis=basis;m.al=al
    P,W=seeds(k); x=np.einsum('qa,ead->eqd',P,m.X[m.T[:,:3]]).reshape(-1,2); w=(m.A[:,None]*W).ravel()
    el,L=m.locate(x); act=np.ones(m.ne,bool); B=m.ops(el,L,'ddmp',act); Wd=sp.diags(w)
    H=sp.csr_matrix((L.ravel(),(np.repeat(np.arange(len(el)),3),m.T[el,:3].ravel())),shape=(len(el),m.nv))
    Mp=(H.T@Wd@H).toarray(); inn=~(((m.X<1e-9)|(m.X>1-1e-9)).any(1))
    out=[]
    bd=np.hstack([(H.T@Wd@B[d]).toarray()[:,inn] for d in(0,1)])
    for kind in (0,1):
        if kind==0: A1=(B[0].T@Wd@B[0]+B[1].T@Wd@B[1]).toarray()
        else:
            m2=m.basis; m.basis='plain'; Bp=m.ops(el,L,'ddmp',act); m.basis=m2; A1=(Bp[0].T@Wd@Bp[0]+Bp[1].T@Wd@Bp[1]).toarray()
        A1=A1[np.ix_(inn,inn)]; A=np.kron(np.eye(2),A1)
        S=bd@np.linalg.solve(A,bd.T)
        import scipy.linalg as sl
        ev=sl.eigh(S,Mp,eigvals_only=True); out.append(np.sqrt(np.abs(ev[1])))
    return out
def energies(basis,al,k,n,gen):
    """least and largest ratio of the energy to that of the plain gradients, foot held"""
    import scipy.linalg as sl
    m=DM(np.linspace(0,1,n+1),np.linspace(0,1,n+1),seed=1)
    P,W=seeds(k) if not gen else (None,None)
    if gen: x,v=lattice(m,k,(.3,.7)); w=np.full(len(x),v)
    else: x=np.einsum('qa,ead->eqd',P,m.X[m.T[:,:3]]).reshape(-1,2); w=(m.A[:,None]*W).ravel()
    el,L=m.locate(x); act=np.zeros(m.ne,bool); act[el]=True
    m.basis='plain'; K0,_=stiff(m,el,L,w,act); m.basis=basis; m.al=al; m.pw=w if basis=='dbub' else None; K1,_=stiff(m,el,L,w,act)
    fix=m.X[:,1]<1e-9; i=np.where(~np.r_[fix,fix])[0]
    ev=sl.eigvalsh(K1[np.ix_(i,i)],K0[np.ix_(i,i)]); return ev[0],ev[-1]
